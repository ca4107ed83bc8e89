//! A test declaration that uses all features of the macros.

use super::*;
use crate::{FileId, Severity, Span};

choices! {
    /// A colour.
    pub enum Colour {
        /// Red.
        #[default]
        Red = "red",
        /// Blue.
        Blue = "blue",
    }
}

settings! {
    /// A pen.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Pen {
        /// Its tip.
        tip: Tip = Tip::default() => ..;
        /// Width
        /// or height.
        size: [u32; 2] = [1, 2] => ["width"[0] | "size": at_least(1.0).unit("mm"), "height"[1] | "size"];
        /// Its colour.
        colour: Colour = Colour::Blue => ["colour"];
        /// What was drawn with it.
        strokes: Vec<u32> = vec![];
    }
}

settings! {
    /// The tip of a pen.
    #[derive(Clone, Debug, PartialEq)]
    pub enum Tip = Ball {
        /// A ball.
        Ball(Ball) = "ball" | "biro",
        /// A brush.
        Brush = "brush" (not drawn) {
            /// Its stiffness.
            stiffness: f32 = 0.5 => ["stiffness": between(0.0, 1.0)];
        },
        /// A nib.
        Nib = "nib",
    }
}

settings! {
    /// A ball.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Ball {
        /// Its radius.
        radius: Option<f32> = None => ["radius": above(0.0)];
        /// Points on its axis.
        axis: [i32; 2] = [-1, 1] => ["axis"];
    }
}

fn listed(pen: &Pen) -> String {
    let texts = pen.settings().into_iter().map(|setting| format!("{}={}", setting.field.name, setting.value));
    texts.collect::<Vec<_>>().join(" ")
}

#[test]
fn a_declaration_gives_values_names_and_help() {
    assert_eq!(listed(&Pen::default()), "radius=automatic axis=-1,1 width=1 height=2 colour=blue");
    let settings = Pen::default().settings();
    let width = settings[2].field;
    assert_eq!((width.help, width.domain.unit), ("Width or height.", "mm"));
    assert_eq!(settings[4].kind, Kind::Choice(&["red", "blue"]));
}

#[test]
fn members_are_found_by_any_of_their_names() {
    let names: Vec<_> = Pen::members().iter().map(Settings::name).collect();
    assert_eq!(names, ["ball", "brush", "nib"]);
    let brush = Pen::called("brush").unwrap();
    assert_eq!(listed(&brush), "stiffness=0.5 width=1 height=2 colour=blue");
    assert!(!brush.member().unwrap().is_drawn && Pen::default().member().unwrap().is_drawn);
    assert_eq!(Tip::called("biro"), Some(Tip::default()));
    assert_eq!(Tip::called("quill"), None);
    assert_eq!(Ball::default().name(), "");
}

#[test]
fn settings_are_set_by_text() {
    let mut pen = Pen::default();
    assert_eq!(pen.set_text("size", " 7"), Ok(vec!["width", "height"]));
    assert_eq!(pen.set_text("radius", "0.25"), Ok(vec!["radius"]));
    assert_eq!(pen.set_text("axis", "3, -4"), Ok(vec!["axis"]));
    assert_eq!(pen.set_text("colour", "red"), Ok(vec!["colour"]));
    assert_eq!(pen.set_text("stiffness", "0.5"), Ok(vec![]), "a ball has none");
    let before = "radius=0.25 axis=3,-4 width=7 height=7 colour=red";
    assert_eq!(listed(&pen), before);
    for (name, text, values) in [
        ("width", "0", "a whole number of 1 or more"),
        ("height", "-1", "a whole number of 0 or more"),
        ("height", "1.5", "a whole number of 0 or more"),
        ("radius", "inf", "a number above 0"),
        ("radius", "NaN", "a number above 0"),
        ("axis", "1", "2 values separated by commas, each a whole number"),
        ("colour", "green", "one of red, blue"),
    ] {
        assert_eq!(pen.set_text(name, text), Err(values.to_owned()), "{name}={text}");
    }
    assert_eq!(listed(&pen), before);
}

#[test]
fn a_value_outside_its_domain_is_an_error_at_its_parameter() {
    let span = |start| Span::new(FileId(0), start, start + 1);
    let origin = Origin { span: span(1), parameters: vec![("width", span(2))] };
    let mut pen = Pen { tip: Tip::Brush { stiffness: f32::NAN }, size: [0, 0], ..Pen::default() };
    let errors = pen.check(&origin);
    assert!(errors.iter().all(|error| error.severity == Severity::Error));
    let found: Vec<_> = errors.iter().map(|error| (error.span().start, error.message.as_str())).collect();
    let expected = [
        (1, "`stiffness` is a number between 0 and 1, not NaN"),
        (2, "`width` is a whole number of 1 or more, not 0"),
    ];
    assert_eq!(found, expected);
    (pen.tip, pen.size) = (Tip::Nib, [1, 1]);
    assert_eq!(pen.check(&origin), []);
}

#[test]
fn domains_are_described() {
    for (domain, kind, description) in [
        (Domain::ANY, Kind::Number, "a finite number"),
        (Domain::ANY, Kind::Integer, "a whole number"),
        (Domain::ANY, Kind::Count, "a whole number of 0 or more"),
        (above(0.0).at_most(f64::INFINITY), Kind::Number, "a number above 0"),
        (above(0.0).at_most(1.0), Kind::Number, "a number above 0 and at most 1"),
        (from(2.0, 1024.0), Kind::Count, "a whole number from 2 to 1024"),
        (with_extension(".ply"), Kind::Text, "a name that ends in .ply"),
        (one_of(&["a", "b"]), Kind::Text, "one of a, b"),
    ] {
        assert_eq!(domain.describe(kind), description);
    }
    assert!(above(0.0).at_most(f64::INFINITY).contains(&Value::Number(f32::INFINITY)));
    assert!(with_extension(".ply").contains(&Value::Text("A.PLY".into())));
    assert!(!with_extension(".ply").contains(&Value::Text("a.obj".into())));
}
