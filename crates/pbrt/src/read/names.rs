//! Names of the format, and the replacements of names of its older versions.

/// Lines `set | name | what replaced it` for names of versions 1 to 3.
const REPLACED: &str = include_str!("../../data/replaced-names.txt");

/// The lines of a table, without comments.
fn lines(table: &'static str) -> impl Iterator<Item = &'static str> + Clone {
    table.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// What replaced a name of an older version; `None` if there was no such name.
pub(crate) fn replaced(set: &str, name: &str) -> Option<&'static str> {
    lines(REPLACED).find_map(|line| {
        let mut fields = line.splitn(3, '|').map(str::trim);
        (fields.next() == Some(set) && fields.next() == Some(name)).then(|| fields.next())?
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_replaced_names_is_well_formed() {
        for line in lines(REPLACED) {
            let fields: Vec<_> = line.splitn(3, '|').map(str::trim).collect();
            assert!(fields.len() == 3 && fields.iter().all(|field| !field.is_empty()), "{line}");
            assert!(replaced(fields[0], fields[1]).is_some());
        }
        assert_eq!(
            replaced("material", "glass"),
            Some("write `dielectric`; for thin sheets `thindielectric`")
        );
        assert_eq!(replaced("material", "diffuse"), None);
    }
}
