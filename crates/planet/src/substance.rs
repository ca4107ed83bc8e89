//! What spheres are made of.

/// What a sphere is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Substance {
    /// The core, whose smooth ice is a mirror where no land covers it.
    Ice,
    /// Meadows.
    Grass,
    /// Darker meadows.
    Moss,
    /// Shores.
    Sand,
    /// Rocks and high hills.
    Stone,
    /// The highest hills.
    Snow,
    /// Trunks.
    Wood,
    /// Broadleaves.
    Leaves,
    /// Broadleaves in autumn.
    AutumnLeaves,
    /// Trees in blossom.
    Blossom,
    /// Spruces.
    Needles,
    /// Red flowers and balls.
    Red,
    /// Yellow ones.
    Yellow,
    /// White ones.
    White,
    /// Blue ones.
    Blue,
    /// Mirrors, of which the moon is one.
    Silver,
    /// Golden mirrors.
    Gold,
    /// Glass.
    Glass,
}

impl Substance {
    /// All of them, in order.
    pub const ALL: [Self; 18] = [
        Self::Ice,
        Self::Grass,
        Self::Moss,
        Self::Sand,
        Self::Stone,
        Self::Snow,
        Self::Wood,
        Self::Leaves,
        Self::AutumnLeaves,
        Self::Blossom,
        Self::Needles,
        Self::Red,
        Self::Yellow,
        Self::White,
        Self::Blue,
        Self::Silver,
        Self::Gold,
        Self::Glass,
    ];

    /// Its statement in the pbrt format.
    pub fn material(self) -> &'static str {
        match self {
            Self::Ice => r#""conductor" "rgb reflectance" [ 0.32 0.5 0.62 ]"#,
            Self::Grass => r#""diffuse" "rgb reflectance" [ 0.17 0.33 0.06 ]"#,
            Self::Moss => r#""diffuse" "rgb reflectance" [ 0.11 0.24 0.05 ]"#,
            Self::Sand => r#""diffuse" "rgb reflectance" [ 0.68 0.56 0.36 ]"#,
            Self::Stone => r#""diffuse" "rgb reflectance" [ 0.34 0.32 0.3 ]"#,
            Self::Snow => r#""diffuse" "rgb reflectance" [ 0.85 0.87 0.9 ]"#,
            Self::Wood => r#""diffuse" "rgb reflectance" [ 0.2 0.12 0.07 ]"#,
            Self::Leaves => r#""diffuse" "rgb reflectance" [ 0.1 0.3 0.05 ]"#,
            Self::AutumnLeaves => r#""diffuse" "rgb reflectance" [ 0.65 0.22 0.03 ]"#,
            Self::Blossom => r#""diffuse" "rgb reflectance" [ 0.8 0.4 0.5 ]"#,
            Self::Needles => r#""diffuse" "rgb reflectance" [ 0.04 0.15 0.07 ]"#,
            Self::Red => r#""diffuse" "rgb reflectance" [ 0.65 0.04 0.03 ]"#,
            Self::Yellow => r#""diffuse" "rgb reflectance" [ 0.8 0.58 0.04 ]"#,
            Self::White => r#""diffuse" "rgb reflectance" [ 0.8 0.8 0.78 ]"#,
            Self::Blue => r#""diffuse" "rgb reflectance" [ 0.05 0.13 0.6 ]"#,
            Self::Silver => r#""conductor" "rgb reflectance" [ 0.9 0.9 0.88 ]"#,
            Self::Gold => r#""conductor" "rgb reflectance" [ 0.95 0.68 0.24 ]"#,
            Self::Glass => r#""dielectric" "float eta" 1.5"#,
        }
    }

    /// The speed at which a ball of the same size tears it off where it grows, in metres per
    /// second.
    pub(crate) fn firmness(self) -> f32 {
        match self {
            Self::Red | Self::Yellow | Self::White | Self::Blue => 3.0,
            Self::Leaves | Self::AutumnLeaves | Self::Blossom | Self::Needles => 9.0,
            Self::Wood => 60.0,
            _ => 200.0,
        }
    }
}
