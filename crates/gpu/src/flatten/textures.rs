//! Textures.
//!
//! | words | texture |
//! |---|---|
//! | 0, number | the number everywhere |
//! | 1, offset | a spectrum everywhere |
//! | 2, count, and for each operation 4 words: code, target, slots of operands, argument | a program |
//!
//! Slots of operands are bytes of a word. Codes are those of [`Code`] in the order of the constants
//! below, their arguments numbers or offsets: of a spectrum, a direction, or a mapping. Mappings to
//! the plane are the columns of a matrix; those to texture space are three rows of one.

use description::Span;
use math::Vec2;
use scene::texture::{Code, FloatTextureId, Mapping2d, Operation, SpectrumTextureId};

use super::Flattener;

const NUMBER: u32 = 0;
const SPECTRUM: u32 = 1;
const PROGRAM: u32 = 2;

// The codes of operations.
const CODE_NUMBER: u32 = 0;
const CODE_SPECTRUM: u32 = 1;
const CODE_SQUARES: u32 = 2;
const CODE_CUBES: u32 = 3;
const CODE_FACING: u32 = 4;
const CODE_STEP: u32 = 5;
const CODE_SCALE: u32 = 6;
const CODE_MIX: u32 = 7;
const CODE_BILERP: u32 = 8;

impl Flattener<'_> {
    /// A texture of numbers, which a thing at `span` has; its offset.
    pub fn number_texture(&mut self, FloatTextureId(id): FloatTextureId, span: Span) -> u32 {
        self.texture(id, span)
    }

    /// A texture of spectra, which a thing at `span` has; its offset.
    pub fn spectrum_texture(&mut self, SpectrumTextureId(id): SpectrumTextureId, span: Span) -> u32 {
        self.texture(id, span)
    }

    fn texture(&mut self, id: u32, span: Span) -> u32 {
        let textures = self.scene.textures();
        let program = textures.programs()[id as usize];
        let operations = &textures.operations()[program.first as usize..][..program.length as usize];
        match operations {
            [Operation { code: Code::Number(number), .. }] => self.slab.add([NUMBER, number.to_bits()]),
            [Operation { code: Code::Spectrum(index), .. }] => {
                let spectrum = self.spectrum(&textures.spectra()[*index as usize]);
                self.slab.add([SPECTRUM, spectrum])
            }
            operations => {
                let mut words = vec![PROGRAM, operations.len() as u32];
                for operation in operations {
                    let [code, argument] = self.code(operation.code, span);
                    words.extend([
                        code,
                        operation.target.into(),
                        u32::from_le_bytes(operation.operands),
                        argument,
                    ]);
                }
                self.slab.add(words)
            }
        }
    }

    /// The code of an operation, and its argument.
    fn code(&mut self, code: Code, span: Span) -> [u32; 2] {
        let textures = self.scene.textures();
        let what = match code {
            Code::Number(number) => return [CODE_NUMBER, number.to_bits()],
            Code::Spectrum(index) => {
                return [CODE_SPECTRUM, self.spectrum(&textures.spectra()[index as usize])];
            }
            Code::Squares(index) => return [CODE_SQUARES, self.mapping(index, span)],
            Code::Cubes(index) => {
                let matrix = textures.solid_mappings()[index as usize].texture_from_render.matrix();
                let rows = [0, 1, 2].map(|row| matrix.row(row).to_array());
                return [CODE_CUBES, self.slab.add_numbers(rows.into_iter().flatten())];
            }
            Code::Facing(index) => {
                let direction = textures.directions()[index as usize];
                return [CODE_FACING, self.slab.add_numbers(direction.to_array())];
            }
            Code::Step(edge) => return [CODE_STEP, edge.to_bits()],
            Code::Scale => return [CODE_SCALE, 0],
            Code::Mix => return [CODE_MIX, 0],
            Code::Bilerp(index) => return [CODE_BILERP, self.mapping(index, span)],
            Code::FloatImage(_) | Code::SpectrumImage(_) => "textures of images",
            Code::Dots(_) => "texture `dots`",
            Code::Fbm(_) => "texture `fbm`",
            Code::Wrinkled(_) => "texture `wrinkled`",
            Code::Windy(_) => "texture `windy`",
            Code::Marble(_) => "texture `marble`",
        };
        self.refuse(what, span);
        [CODE_NUMBER, 0]
    }

    /// A mapping to the plane; its offset.
    fn mapping(&mut self, index: u32, span: Span) -> u32 {
        let columns = match &self.scene.textures().mappings()[index as usize] {
            &Mapping2d::Uv { scale, delta } => [Vec2::new(scale.x, 0.0), Vec2::new(0.0, scale.y), delta],
            Mapping2d::Affine { columns } => *columns,
            Mapping2d::Spherical { .. } | Mapping2d::Cylindrical { .. } | Mapping2d::Planar { .. } => {
                self.refuse("mappings of textures other than `uv`", span);
                return 0;
            }
        };
        self.slab.add_numbers(columns.iter().flat_map(|v| v.to_array()))
    }
}
