//! What the package says of itself agrees with how it is built.

/// The stable interface of Python that the library uses is that of the oldest version allowed.
#[test]
fn the_oldest_python_is_that_of_the_stable_interface() {
    let workspace = include_str!("../../../Cargo.toml");
    let (_, version) = workspace.split_once("abi3-py3").expect("a stable interface");
    let version: String = version.chars().take_while(char::is_ascii_digit).collect();
    let package = include_str!("../pyproject.toml");
    assert!(package.contains(&format!("requires-python = \">=3.{version}\"")), "{version}");
}
