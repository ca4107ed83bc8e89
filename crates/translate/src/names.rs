//! Identifiers of WGSL.

/// Keywords, reserved words and predeclared functions that names of Rust may collide with.
const TAKEN: &str = "\
    abs acos active alias all any asin asm atan atan2 attribute auto await bitcast bool break case \
    cast catch ceil clamp class common const const_assert continue continuing cos cross default \
    degrees delete demote diagnostic discard distance do dot else enable enum exp exp2 explicit \
    export extends extern external f16 f32 fallthrough false filter final finally floor fma fn for \
    fract friend from get goto groupshared highp i32 if impl implements import inline instanceof \
    interface layout length let log log2 loop lowp macro match max mediump meta min mix mod module \
    move mut mutable namespace new nil noexcept normalize null of operator override package \
    packoffset pass patch pow precise precision premerge priv private protected ptr pub public \
    radians ref reflect refract regardless register require resource restrict return round select \
    self set shared sign sin smooth snorm sqrt static std step struct super switch tan target \
    template this throw trait true trunc try type typedef u32 union unless unorm unsafe unsized use \
    using var varying vec2f vec3f vec4f virtual volatile where while with writeonly yield";

/// Whether WGSL has another use for a name.
pub fn is_taken(name: &str) -> bool {
    TAKEN.split(' ').any(|taken| taken == name)
}

/// A name that WGSL accepts for a member of a struct.
pub fn member(name: &str) -> String {
    match name {
        _ if name.starts_with(|c: char| c.is_ascii_digit()) => format!("v{name}"),
        _ if is_taken(name) => format!("{name}_"),
        _ => name.to_owned(),
    }
}

/// Whether a text is one identifier.
pub fn is_identifier(text: &str) -> bool {
    syn::parse_str::<syn::Ident>(text).is_ok()
}

/// Whether a text is a literal, with its sign.
pub fn is_number(text: &str) -> bool {
    syn::parse_str::<syn::Lit>(text).is_ok()
}
