//! What was removed is refused by its name, with what to do now.

use spunlaid::fibre::case::keys;
use spunlaid::ground::{REMOVED, Removed};
use spunlaid::input::{Overrides, parse_study, read_case, read_web, starter_case};

const WEB: &str = "
[fibre]
diameter = '18 µm'
density = '910 kg/m³'
[laydown]
sigma_md = '10 mm'
sigma_cd = '10 mm'
noise = '12 m^-0.5'
[line]
feed_speed = '50 m/s'
belt_speed = '3 m/s'
filaments_per_metre = 500
[web]
width = '1 m'
length = '1 m'
";

/// Whatever file a removed key belonged to, each reader reports it: from outside and, of a case, in code.
#[test]
fn rejects_removed_keys_with_the_way_out() {
    let mut count = 0;
    for (kind, name, since, way_out) in REMOVED.iter().filter(|(kind, ..)| *kind == Removed::Key) {
        let key = if name.contains('.') { (*name).to_owned() } else { format!("{name}.any") };
        let set = [(key.clone(), "1".to_owned())];
        let set = Overrides::new(&set, "--set");
        let wanted = format!("--set {key} = 1 is gone since {since}; {way_out}");
        let case = read_case((starter_case(), "starter.toml"), set).unwrap_err().to_string();
        let web = read_web((WEB, "web.toml"), set).unwrap_err().to_string();
        assert!(case.contains(&wanted) && web.contains(&wanted), "{case}\n{web}\n{wanted}");
        assert!(keys::named(&key).unwrap_err().to_string().contains(way_out));
        let study = format!(
            "case = \"starter.toml\"\ndesign = \"grid\"\nreplicates = 2\n[vary]\n\"{key}\" = [1, 2]\n"
        );
        let study =
            parse_study(&study, "study.toml", None, |_, _| Ok((starter_case().to_owned(), String::new())));
        let said = study.unwrap_err().to_string();
        assert!(said.contains(way_out), "{kind:?} {said}");
        count += 1;
    }
    assert!(count > 0);
}
