//! What a key says of other keys, over every table of keys.

use spunlaid_experiment::STUDY;
use spunlaid_fibre::case::keys::{CASE, Key, KeyTable, Kind, Omission, Relations};
use spunlaid_simulation::WEB;
use spunlaid_simulation::layers::keys::{OF_FILAMENT, WEB_FILE};

/// Whether a value is one of a key, as text.
fn takes<T>(key: &Key<T>, value: &str) -> bool {
    key.words.contains(&value) || key.kind.accept(value.trim_matches('"').into()).is_ok()
}

/// Panics where a row names a key that is not there, or a value that its key does not take.
fn check_relations<T>(table: &KeyTable<T>) {
    let is_known = |name: &&str| table.find(name).is_some() || table.list(name).is_some();
    for key in table.rows {
        let Relations { alternative_to, remedy, read_after, .. } = key.relations;
        assert!([alternative_to, read_after].concat().iter().all(is_known), "{}", key.name);
        assert_eq!(alternative_to.is_empty(), remedy.is_empty(), "{}", key.name);
        // Two keys that give the same one are refused beside each other, or the last would win.
        let shares =
            |other: &&Key<T>| other.relations.alternative_to.iter().any(|name| alternative_to.contains(name));
        let others = table.rows.iter().filter(|other| other.name != key.name).filter(shares);
        others.for_each(|other| assert!(table.are_alternatives(key.name, other.name), "{}", other.name));
        assert_eq!(matches!(key.kind, Kind::File(_)), !key.relations.gives.is_empty(), "{}", key.name);
        let of_case = key.relations.same_in_case.iter().chain(key.relations.gives_case);
        assert!(of_case.copied().all(|name| CASE.find(name).is_some()), "{}", key.name);
        if let Some((name, value)) = key.relations.with_in_one_air {
            assert!(table.find(name).is_some_and(|other| takes(other, value)), "{}", key.name);
        }
        let texts = [key.needed_if, key.default_if];
        assert!(texts.iter().flatten().all(|(_, value)| takes(key, value)), "{}", key.name);
        if let Omission::Required(value) | Omission::Value(value) = key.omission
            && !matches!(key.kind, Kind::File(_) | Kind::Direction | Kind::Other(_))
        {
            assert!(takes(key, value), "{}: {value}", key.name);
        }
    }
}

#[test]
fn relations_name_keys_that_are_there_and_values_that_they_take() {
    check_relations(&CASE);
    check_relations(&WEB);
    check_relations(&WEB_FILE);
    check_relations(&STUDY);
}

#[test]
fn each_table_of_a_case_is_one_of_a_filament() {
    let top = spunlaid_fibre::case::keys::TABLES.into_iter().filter(|table| !table.contains('.'));
    assert!(top.eq(OF_FILAMENT.iter().copied()));
    assert_eq!(WEB.replaced_by(&["line.rows"]), ["line.filaments_per_metre"]);
}
