//! Materials of Wavefront MTL files, with the parameters that other programs have added for
//! principled surfaces.

use super::notes::Notes;
use super::text::{name, statements, unmarked, unquoted, words};
use crate::number;

/// A material; parameters that are not given are absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjMaterial {
    /// The name by which faces refer to it.
    pub name: String,
    /// Diffuse reflectance `Kd`.
    pub diffuse: Option<[f32; 3]>,
    /// Specular reflectance `Ks`.
    pub specular: Option<[f32; 3]>,
    /// Emission `Ke`.
    pub emission: Option<[f32; 3]>,
    /// Transmission filter `Tf`.
    pub filter: Option<[f32; 3]>,
    /// Phong exponent `Ns`.
    pub shininess: Option<f32>,
    /// Index of refraction `Ni`.
    pub index_of_refraction: Option<f32>,
    /// Opacity: `d`, or one minus `Tr`.
    pub opacity: Option<f32>,
    /// Illumination model `illum`.
    pub illumination: Option<i32>,
    /// Map of the diffuse reflectance.
    pub diffuse_map: Option<Map>,
    /// Map of the emission.
    pub emission_map: Option<Map>,
    /// Map of the opacity.
    pub opacity_map: Option<Map>,
    /// Map of heights.
    pub bump_map: Option<Map>,
    /// Map of normals.
    pub normal_map: Option<Map>,
    /// The numbers of a principled surface, in the order of [`PRINCIPLED`].
    pub principled: [Option<f32>; PRINCIPLED.len()],
    /// Maps of these numbers.
    pub principled_maps: [Option<Map>; PRINCIPLED.len()],
}

/// Statements of principled surfaces, with the parameters of OpenPBR that they give.
pub const PRINCIPLED: [(&str, &str); 6] = [
    ("pr", "specular_roughness"),
    ("pm", "base_metalness"),
    ("ps", "fuzz_weight"),
    ("pc", "coat_weight"),
    ("pcr", "coat_roughness"),
    ("aniso", "specular_roughness_anisotropy"),
];

impl ObjMaterial {
    /// Whether it has a map of any kind.
    pub fn has_maps(&self) -> bool {
        let maps =
            [&self.diffuse_map, &self.emission_map, &self.opacity_map, &self.bump_map, &self.normal_map];
        maps.into_iter().chain(&self.principled_maps).any(Option::is_some)
    }

    /// Whether it is a principled surface.
    pub fn is_principled(&self) -> bool {
        self.principled.iter().any(Option::is_some) || self.principled_maps.iter().any(Option::is_some)
    }
}

/// A picture, and how it is mapped.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The name of its file.
    pub file: String,
    /// Factors on texture coordinates.
    pub scale: [f32; 2],
    /// The offset of texture coordinates, added after the factors.
    pub offset: [f32; 2],
    /// The offset of values, which are multiplied by `gain` first.
    pub base: f32,
    /// The factor on values.
    pub gain: f32,
    /// A factor on bumps.
    pub bump: f32,
    /// Whether the picture is not repeated.
    pub clamps: bool,
    /// The channel whose values are taken.
    pub channel: Option<Channel>,
}

/// A channel of a picture: one of its own, or the mean of red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Channel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Alpha.
    Alpha,
    /// The mean of red, green and blue.
    Mean,
}

impl Map {
    /// A picture that is mapped as it is.
    pub fn new(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            base: 0.0,
            gain: 1.0,
            bump: 1.0,
            clamps: false,
            channel: None,
        }
    }

    /// The map of a statement: options, and the name of a file, which may have spaces. Options may
    /// also follow the name.
    fn parse(statement: &[u8], line: usize, notes: &mut Notes) -> Option<Self> {
        let text = String::from_utf8_lossy(statement);
        let mut map = Self::new("");
        // Words by their places in the text, so that a name keeps its spaces.
        let start = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
        let mut words = text.split_whitespace().skip(1).peekable();
        let (mut first, mut last) = (None, 0);
        while let Some(word) = words.next() {
            if !is_option(word) {
                first.get_or_insert(start(word));
                last = start(word) + word.len();
                continue;
            }
            let mut numbers = [None; 3];
            let takes = match word {
                "-s" | "-o" | "-t" => 3,
                "-mm" => 2,
                "-bm" | "-boost" | "-texres" => 1,
                _ => 0,
            };
            for number in &mut numbers[..takes] {
                let Some(value) = words.peek().and_then(|word| number::float(word.as_bytes())) else { break };
                *number = Some(value);
                words.next();
            }
            let argument = if takes == 0 { words.next().unwrap_or("") } else { "" };
            let [u, v, _] = numbers;
            let pair = |default: f32| [u.unwrap_or(default), v.unwrap_or(default)];
            match word {
                "-s" => map.scale = pair(1.0),
                "-o" => map.offset = pair(0.0),
                "-mm" => (map.base, map.gain) = (u.unwrap_or(0.0), v.unwrap_or(1.0)),
                "-bm" => map.bump = u.unwrap_or(1.0),
                "-clamp" => map.clamps = argument == "on",
                "-imfchan" => {
                    map.channel = match argument {
                        "r" => Some(Channel::Red),
                        "g" => Some(Channel::Green),
                        "b" => Some(Channel::Blue),
                        "m" => Some(Channel::Alpha),
                        "l" => Some(Channel::Mean),
                        _ => {
                            notes.add(line, format!("the channel `{argument:.40}` of pictures is not read"));
                            None
                        }
                    };
                }
                _ => notes.add(line, format!("the option `{word}` is not read")),
            }
        }
        let name = &text[first?..last];
        map.file = unquoted(name).replace('\\', "/");
        Some(map)
    }
}

fn is_option(word: &str) -> bool {
    const OPTIONS: [&str; 14] = [
        "-s",
        "-o",
        "-t",
        "-mm",
        "-bm",
        "-clamp",
        "-imfchan",
        "-blendu",
        "-blendv",
        "-boost",
        "-cc",
        "-texres",
        "-type",
        "-colorspace",
    ];
    OPTIONS.contains(&word)
}

/// Reads an MTL file, and says what of it is not read. A mesh is not refused for its materials.
pub fn read_materials(bytes: &[u8]) -> (Vec<ObjMaterial>, Vec<String>) {
    let (mut materials, mut notes) = (Vec::<ObjMaterial>::new(), Notes::default());
    for (line, statement) in statements(&unmarked(bytes)) {
        let keyword = words(&statement).next().unwrap_or(b"");
        let keyword = String::from_utf8_lossy(keyword).to_ascii_lowercase();
        if keyword == "newmtl" {
            materials.push(ObjMaterial { name: name(&statement), ..ObjMaterial::default() });
        } else if let Some(material) = materials.last_mut() {
            material.set(&keyword, line, &statement, &mut notes);
        } else if !keyword.is_empty() {
            notes.add(line, format!("`{keyword:.40}` stands before the first `newmtl`"));
        }
    }
    (materials, notes.into_texts())
}

impl ObjMaterial {
    fn set(&mut self, keyword: &str, line: usize, statement: &[u8], notes: &mut Notes) {
        let values = words(statement).skip(1);
        let mut number = || {
            let number = values.clone().next().and_then(number::float).filter(|value| value.is_finite());
            if number.is_none() {
                notes.add(line, format!("`{keyword}` is no number: it is not read"));
            }
            number
        };
        let index = |name: &str| PRINCIPLED.iter().position(|(statement, _)| *statement == name);
        if let Some(index) = index(keyword) {
            self.principled[index] = number();
            return;
        }
        if let Some(index) = keyword.strip_prefix("map_").and_then(index) {
            self.principled_maps[index] = Map::parse(statement, line, notes);
            return;
        }
        match keyword {
            "ns" => self.shininess = number(),
            "ni" => self.index_of_refraction = number(),
            "illum" => self.illumination = number().map(|model| model as i32),
            "d" => self.dissolve(line, values, notes),
            "tr" if self.opacity.is_none() => {
                self.opacity = number().map(|transparency| 1.0 - transparency);
                if self.opacity == Some(0.0) {
                    self.opacity = None;
                    let message = "`Tr` 1 without `d` is drawn as opaque, as programs write it that mean `d`";
                    notes.add(line, message);
                }
            }
            "tr" => (),
            "kd" | "ks" | "ke" | "tf" => {
                let color = color(values);
                if color.is_none() {
                    notes.add(
                        line,
                        format!("`{keyword}` is no colour of one or three numbers: it is not read"),
                    );
                }
                let place = match keyword {
                    "kd" => &mut self.diffuse,
                    "ks" => &mut self.specular,
                    "ke" => &mut self.emission,
                    _ => &mut self.filter,
                };
                *place = color.or(*place);
            }
            "map_kd" | "map_ke" | "map_d" | "map_bump" | "bump" | "norm" | "map_norm" | "map_kn" => {
                let map = Map::parse(statement, line, notes);
                if map.is_none() {
                    notes.add(line, format!("`{keyword}` names no file"));
                }
                match keyword {
                    "map_kd" => self.diffuse_map = map,
                    "map_ke" => self.emission_map = map,
                    "map_d" => self.opacity_map = map,
                    "map_bump" | "bump" => self.bump_map = map,
                    _ => self.normal_map = map,
                }
            }
            // Light that comes from everywhere is traced.
            "ka" | "map_ka" => (),
            "anisor" if number() == Some(0.0) => (),
            _ => notes.add(line, format!("`{keyword:.40}` is not read")),
        }
    }

    /// `d factor`, or `d -halo factor`, of which the middle of an object has the factor.
    fn dissolve<'a>(&mut self, line: usize, values: impl Iterator<Item = &'a [u8]>, notes: &mut Notes) {
        let mut values = values.peekable();
        if values.next_if(|word| word.eq_ignore_ascii_case(b"-halo")).is_some() {
            notes.add(line, "`d -halo` is drawn as `d`: as much at the edge as in the middle");
        }
        self.opacity = values.next().and_then(number::float).filter(|value| value.is_finite());
        match self.opacity {
            None => notes.add(line, "`d` is no number: it is not read"),
            Some(0.0) => notes.add(line, "`d` 0 makes a material invisible"),
            Some(_) => (),
        }
    }
}

/// A colour of three numbers, or of one that holds for all three.
fn color<'a>(values: impl Iterator<Item = &'a [u8]>) -> Option<[f32; 3]> {
    let values: Vec<f32> = values.map_while(number::float).filter(|value| value.is_finite()).collect();
    match values[..] {
        [r, g, b, ..] => Some([r, g, b]),
        [value] => Some([value; 3]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_read_and_what_is_not_is_named() {
        let text = b"\xef\xbb\xbfnewmtl red paint #1\nKD 1 0 0\nKe nonsense\nNs 20\nTr 0.25\nKa 1 1 1\n\
            Kd spectral a.rfl\nPr .5\nsharpness 60\nnewmtl b\nKd .5\nTr 1\nnewmtl c\nd -halo .3\nTr 0\nillum 2.0";
        let (materials, warnings) = read_materials(text);
        assert_eq!(materials[0].name, "red paint #1");
        assert_eq!((materials[0].diffuse, materials[0].emission), (Some([1.0, 0.0, 0.0]), None));
        assert_eq!((materials[0].opacity, materials[0].principled[0]), (Some(0.75), Some(0.5)));
        assert_eq!((materials[1].diffuse, materials[1].opacity), (Some([0.5; 3]), None));
        assert_eq!((materials[2].opacity, materials[2].illumination), (Some(0.3), Some(2)));
        let expected = [
            "line 3: `ke` is no colour of one or three numbers: it is not read",
            "line 7: `kd` is no colour of one or three numbers: it is not read",
            "line 9: `sharpness` is not read",
            "line 12: `Tr` 1 without `d` is drawn as opaque, as programs write it that mean `d`",
            "line 14: `d -halo` is drawn as `d`: as much at the edge as in the middle",
        ];
        assert_eq!(warnings, expected);
    }

    #[test]
    fn maps_have_options_before_and_after_names_with_spaces() {
        let map = |text: &str| Map::parse(text.as_bytes(), 1, &mut Notes::default());
        let named = |file: &str| Map::new(file);
        assert_eq!(map("map_Kd  two  words.png "), Some(named("two  words.png")));
        assert_eq!(map("map_Kd \"a b.png\""), Some(named("a b.png")));
        assert_eq!(map("map_Kd tex\\a #1.png"), Some(named("tex/a #1.png")));
        assert_eq!(map("map_Kd -s 2 3 1 1.png"), Some(Map { scale: [2.0, 3.0], ..named("1.png") }));
        let both = Map { scale: [2.0, 1.0], offset: [0.5, 0.25], ..named("a.png") };
        assert_eq!(map("map_Kd -s 2 -o .5 .25 a.png"), Some(both));
        let bump = Map { bump: 0.5, clamps: true, channel: Some(Channel::Green), ..named("a -b.png") };
        assert_eq!(map("bump -clamp on a -b.png -bm 0.5 -imfchan g"), Some(bump));
        assert_eq!(map("map_d -mm 0.25 0.5 a"), Some(Map { base: 0.25, gain: 0.5, ..named("a") }));
        assert_eq!(map("map_d -mm 0 1"), None);
    }
}
