//! Directives that declare something: settings, materials, textures, media, lights, shapes,
//! objects.

use std::collections::hash_map::Entry;
use std::sync::Arc;

use description::schema::Settings;
use description::{ColorSpaceDesc, Diagnostic, OptionsDesc, Span, Spanned};

use super::interpreter::{Abandoned, Interpreter, Step};
use super::names;
use super::parameter::{self, ParameterType, RawParameter};
use super::state::{Attributes, BlockKind, MaterialReference};
use super::statement::{
    CameraStatement, InstanceStatement, LightStatement, MaterialStatement, MediumStatement, ObjectStatement,
    ShapeStatement, Statement, Statements, TextureStatement,
};
use super::token::{TokenKind, Tokens};
use description::did_you_mean;

impl Interpreter<'_> {
    /// A statement that a scene has once; a second one replaces the first.
    pub(super) fn only(
        &mut self,
        name: &str,
        span: Span,
        tokens: &mut Tokens,
        earlier: impl Fn(&Statements) -> Option<&Statement>,
    ) -> Step<Statement> {
        let statement = self.statement(span, tokens, "its type", Arc::default())?;
        if let Some(first) = earlier(&self.statements) {
            let message = format!("this `{name}` replaces an earlier one");
            let diagnostic = Diagnostic::warning("replaced-statement", message, span);
            self.report.push(diagnostic.with_label(first.kind.span, "the earlier one"));
        }
        Ok(statement)
    }

    /// Reads the type and the parameters of a statement.
    pub(super) fn statement(
        &mut self,
        span: Span,
        tokens: &mut Tokens,
        what: &str,
        defaults: Arc<Vec<RawParameter>>,
    ) -> Step<Statement> {
        let kind = self.string(tokens, what)?;
        let color_space = self.state.color_space;
        let parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(kind.span, |last| last.span);
        Ok(Statement { span: span.to(end), kind, parameters, defaults, color_space })
    }

    pub(super) fn camera(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let statement =
            self.only("Camera", span, tokens, |all| all.camera.as_ref().map(|camera| &camera.statement))?;
        let camera_from_world = self.state.ctm;
        self.coordinate_systems.insert("camera".into(), camera_from_world.inverse());
        let medium = self.state.outside();
        self.statements.camera = Some(CameraStatement { statement, camera_from_world, medium });
        Ok(())
    }

    /// `Option "name" value`: alone among parameters it is written without its type.
    pub(super) fn option(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the option's name")?;
        let plain: String =
            name.value.chars().filter(|c| !matches!(c, '-' | '_')).map(|c| c.to_ascii_lowercase()).collect();
        let options = OptionsDesc::default().settings();
        let Some(option) = options.iter().find(|option| option.field.name == plain) else {
            let message = format!("there is no option `{}`", name.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&plain, options.iter().map(|option| option.field.name)),
                ..Diagnostic::error("unknown-option", message, name.span)
            });
            return Err(Abandoned);
        };
        let known = option.field.name;
        let kind = ParameterType::of(option.kind)[0];
        let (values, end) =
            parameter::values(tokens, kind, known, name.span, &mut self.report).ok_or(Abandoned)?;
        self.statements.options.retain(|earlier| earlier.name != known);
        self.statements.options.push(RawParameter {
            kind,
            is_typed: true,
            name: known.to_owned(),
            values,
            row: None,
            span: name.span.to(end),
            declaration: name.span,
            color_space: self.state.color_space,
        });
        Ok(())
    }

    pub(super) fn color_space(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the colour space")?;
        let Some(space) = ColorSpaceDesc::named(&name.value) else {
            let message = format!("there is no colour space `{}`", name.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&name.value, ColorSpaceDesc::NAMES.iter().copied()),
                ..Diagnostic::error("unknown-color-space", message, name.span)
            });
            return Err(Abandoned);
        };
        self.state.color_space = space;
        Ok(())
    }

    pub(super) fn attribute(&mut self, tokens: &mut Tokens) -> Step {
        let target = self.string(tokens, "what the attributes are for")?;
        let given = parameter::parameters(tokens, self.state.color_space, &mut self.report);
        let Some(list) = self.state.attributes.target(&target.value) else {
            let message = format!("there are no attributes for `{}`", target.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&target.value, Attributes::TARGETS),
                ..Diagnostic::error("unknown-attribute-target", message, target.span)
            });
            return Ok(());
        };
        let names = given.iter().map(|parameter| Spanned::new(parameter.name.clone(), parameter.declaration));
        self.statements.attributes.extend(names);
        let list = Arc::make_mut(list);
        list.retain(|earlier| given.iter().all(|new| new.name != earlier.name));
        list.extend(given);
        Ok(())
    }

    pub(super) fn object_begin(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the object's name")?;
        if self.object.is_some() {
            self.report.error("unbalanced-block", "an object cannot be defined inside another one", span);
            return Err(Abandoned);
        }
        self.begin_block(BlockKind::Object, span)?;
        self.object = Some(ObjectStatement { name, shapes: Vec::new(), instances: Vec::new() });
        Ok(())
    }

    pub(super) fn object_end(&mut self, span: Span) -> Step {
        self.end_block(BlockKind::Object, span)?;
        self.statements.objects.extend(self.object.take());
        Ok(())
    }

    pub(super) fn object_instance(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let object = self.string(tokens, "the object's name")?;
        let world_from_object = self.state.ctm.over(self.times());
        let span = span.to(object.span);
        let instances = match &mut self.object {
            Some(object) => &mut object.instances,
            None => &mut self.statements.instances,
        };
        instances.push(InstanceStatement { object, span, world_from_object });
        Ok(())
    }

    pub(super) fn make_named_material(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the material's name")?;
        let kind_span = name.span;
        let color_space = self.state.color_space;
        let mut parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(kind_span, |last| last.span);
        let defaults = self.state.attributes.material.clone();
        let kind = self.take_type("material", &name, &mut parameters)?;
        let statement = Statement { span: span.to(end), kind, parameters, defaults, color_space };
        self.statements.materials.push(MaterialStatement { statement, name: Some(name) });
        Ok(())
    }

    pub(super) fn make_named_medium(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the medium's name")?;
        let color_space = self.state.color_space;
        let mut parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(name.span, |last| last.span);
        let defaults = self.state.attributes.medium.clone();
        let kind = self.take_type("medium", &name, &mut parameters)?;
        let statement = Statement { span: span.to(end), kind, parameters, defaults, color_space };
        let world_from_medium = self.state.ctm.over(self.times());
        self.statements.media.push(MediumStatement { statement, name, world_from_medium });
        Ok(())
    }

    /// Takes the parameter `"string type"` out of a list.
    pub(super) fn take_type(
        &mut self,
        what: &str,
        name: &Spanned<String>,
        parameters: &mut Vec<RawParameter>,
    ) -> Step<Spanned<String>> {
        let place = parameters.iter().position(|parameter| parameter.name == "type");
        let given = place.map(|place| parameters.remove(place));
        if let Some(RawParameter { values: parameter::Values::Strings(mut strings), .. }) = given
            && strings.len() == 1
        {
            return Ok(strings.remove(0));
        }
        let message = format!("the {what} `{}` needs its type, as in `\"string type\" \"…\"`", name.value);
        self.report.error("missing-parameter", message, name.span);
        Err(Abandoned)
    }

    pub(super) fn texture(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the texture's name")?;
        let value = self.string(tokens, "`\"float\"` or `\"spectrum\"`")?;
        let defaults = self.state.attributes.texture.clone();
        let statement = self.statement(span, tokens, "the texture's type", defaults)?;
        let world_from_texture = self.state.ctm.0[0];
        if self.state.ctm.0[0] != self.state.ctm.0[1] {
            let message = "textures do not move: the transform at the start of the shutter is used";
            self.report.warning("ignored", message, span);
        }
        let textures = match value.value.as_str() {
            "float" => &mut self.statements.float_textures,
            "spectrum" => &mut self.statements.spectrum_textures,
            other => {
                let message = format!("a texture's values are of type `float` or `spectrum`, not `{other}`");
                self.report.push(match names::replaced("texture-value", other) {
                    Some(replacement) => {
                        Diagnostic::error("old-name", message, value.span).with_help(replacement)
                    }
                    None => Diagnostic {
                        help: did_you_mean(other, ["float", "spectrum"]),
                        ..Diagnostic::error("unknown-type", message, value.span)
                    },
                });
                if other != "color" {
                    return Ok(());
                }
                &mut self.statements.spectrum_textures
            }
        };
        let is_spectrum = value.value != "float";
        match self.statements.texture_names.entry((is_spectrum, name.value.clone())) {
            Entry::Occupied(first) => {
                let message = format!("there is already a {} texture `{}`", value.value, name.value);
                let diagnostic = Diagnostic::error("redefinition", message, name.span);
                self.report.push(diagnostic.with_label(*first.get(), "first defined here"));
                return Ok(());
            }
            Entry::Vacant(entry) => entry.insert(name.span),
        };
        textures.push(TextureStatement { statement, name, world_from_texture });
        self.statements.texture_order.push(is_spectrum);
        Ok(())
    }

    pub(super) fn shape(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let defaults = self.state.attributes.shape.clone();
        let statement = self.statement(span, tokens, "the shape's type", defaults)?;
        let shape = ShapeStatement {
            statement,
            world_from_object: self.state.ctm.over(self.times()),
            reverse_orientation: self.state.reverse_orientation,
            material: self.state.material.clone(),
            area_light: self.state.area_light,
            medium_interface: self.state.medium_interface.clone(),
        };
        match &mut self.object {
            Some(object) => object.shapes.push(shape),
            None => self.statements.shapes.push(shape),
        }
        Ok(())
    }

    pub(super) fn times(&self) -> [f32; 2] {
        self.statements.transform_times.unwrap_or([0.0, 1.0])
    }

    /// `Material`: for the shapes that follow.
    pub(super) fn material(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let defaults = self.state.attributes.material.clone();
        let statement = self.statement(span, tokens, "the material's type", defaults)?;
        self.state.material = MaterialReference::Nth(self.statements.materials.len() as u32);
        self.statements.materials.push(MaterialStatement { statement, name: None });
        Ok(())
    }

    pub(super) fn medium_interface(&mut self, tokens: &mut Tokens) -> Step {
        let inside = self.string(tokens, "the medium inside")?;
        let two = tokens.peek().kind == TokenKind::Quoted;
        let outside = if two { self.string(tokens, "the medium outside")? } else { inside.clone() };
        self.state.medium_interface = Some([inside, outside]);
        Ok(())
    }

    pub(super) fn light(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let defaults = self.state.attributes.light.clone();
        let statement = self.statement(span, tokens, "the light's type", defaults)?;
        let world_from_light = self.state.ctm.over(self.times());
        let medium = self.state.outside();
        self.statements.lights.push(LightStatement { statement, world_from_light, medium });
        Ok(())
    }

    /// `AreaLightSource`: for the shapes that follow.
    pub(super) fn area_light(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let defaults = self.state.attributes.light.clone();
        let statement = self.statement(span, tokens, "the area light's type", defaults)?;
        self.state.area_light = Some(self.statements.area_lights.len() as u32);
        self.statements.area_lights.push(statement);
        Ok(())
    }
}
