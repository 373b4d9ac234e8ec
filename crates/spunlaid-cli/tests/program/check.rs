//! `check`: what it reports of a case and of a web.

use crate::desk::{Desk, FED, names, success};

#[test]
fn check_prints_a_case_that_can_be_read_again() {
    let desk = Desk::new();
    let said = success(&mut desk.with("check brief.toml", &["air.velocity=12 m/s"]));
    for part in [
        "velocity = \"12 m/s\"",
        "friction_coefficient = 0.9",
        "4 elements of 50 mm, 4 eddies of 50 mm",
        "time step 20 µs, 500 steps; stable below",
        "34.46 µs",
        "axial waves",
        "the shortest, axial waves: sound crosses an element in this time",
        "expected: less than a second on 1 of ",
        "MiB of memory",
        "ready: spunlaid run brief.toml --set 'air.velocity=12 m/s'",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert_eq!(desk.entries(""), names(&["brief.toml"]));
    // What it prints is the case file that a run resolves to, and remarks.
    success(&mut desk.with("run brief.toml --out r", &["air.velocity=12 m/s"]));
    let resolved = String::from_utf8(desk.read("r/case.toml")).unwrap();
    assert!(said.contains(&resolved), "{said}");
    std::fs::write(desk.path("printed.toml"), said.split("\nready").next().unwrap()).unwrap();
    assert!(success(&mut desk.spunlaid("check printed.toml")).contains(&resolved));
}

#[test]
fn check_says_which_place_of_a_field_decides_the_step() {
    let desk = Desk::new();
    // A channel along x whose turbulence is quickest at three quarters of the fibre: ε/k is four times as large there.
    let rows = "x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n";
    let plane = |i: usize, j: usize| {
        let (x, epsilon) = (0.125 * i as f64, if i == 3 { 400.0 } else { 100.0 });
        format!("{x},{},{},8,0,0,1,{epsilon}\n", j % 2, j / 2)
    };
    let all: String = (0..5).flat_map(|i| (0..4).map(move |j| plane(i, j))).collect();
    std::fs::write(desk.path("channel.csv"), rows.to_owned() + &all).unwrap();
    let case = "version = 1\n[fibre]\nlength = \"0.5 m\"\ndiameter = \"20 um\"\ndensity = \"950 kg/m3\"\n\
                youngs_modulus = \"2 GPa\"\nelement_length = \"10 mm\"\n[air]\nfield = \"channel.csv\"\n\
                [run]\nduration = \"10 ms\"\nscheme = \"implicit-tension\"\n";
    std::fs::write(desk.path("channel.toml"), case).unwrap();
    let said = success(&mut desk.spunlaid("check channel.toml"));
    assert!(said.contains("the turbulence changes fastest 37"), "{said}");
    assert!(said.contains("mm from the root, where its cut-off frequency is"), "{said}");
    assert!(
        said.contains("the shortest, waves of the taut string: a wave of the taut fibre crosses"),
        "{said}"
    );
    // A case whose air is the same everywhere has no such place.
    let uniform = Desk::new();
    assert!(!success(&mut uniform.spunlaid("check brief.toml")).contains("changes fastest"));
}

#[test]
fn check_reports_what_was_read_of_a_field_and_the_axis_of_its_air() {
    let desk = Desk::new();
    // A duct along y.
    let rows = "x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n";
    let corner = |i: usize| format!("{},{},{},0,-8,{},1,100\n", i % 2, i / 2 % 2, i / 4, i % 2);
    std::fs::write(desk.path("duct.csv"), rows.to_owned() + &(0..8).map(corner).collect::<String>()).unwrap();
    let case = "version = 1\n[fibre]\nlength = \"0.5 m\"\ndiameter = \"20 um\"\ndensity = \"950 kg/m3\"\n\
        youngs_modulus = \"2 GPa\"\nelement_length = \"10 mm\"\n[air]\nfield = \"duct.csv\"\n\
        field_axis = \"-y\"\n[run]\nduration = \"10 ms\"\n";
    std::fs::write(desk.path("duct.toml"), case).unwrap();
    let said = success(&mut desk.spunlaid("check duct.toml"));
    for part in [
        "#   a structured grid of 2 × 2 × 2 points",
        "#     x from 0 m to 1 m",
        "#   velocity 8 to 8.06 m/s, 8.03 m/s on average",
        "#   k 1 to 1 m²/s², 1 m²/s² on average",
        "#   the air flows along -y of the field (1 of its mean velocity), as the fibre hangs",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    let plane = |i: usize| format!("{},{},0,-8,{},100\n", i % 2, i / 2, 1 + i % 2);
    let flat = "x_m,y_m,u_m_s,v_m_s,k_m2_s2,epsilon_m2_s3\n".to_owned();
    std::fs::write(desk.path("flat.csv"), flat + &(0..4).map(plane).collect::<String>()).unwrap();
    std::fs::write(desk.path("flat.toml"), case.replace("duct.csv", "flat.csv")).unwrap();
    let flat = success(&mut desk.spunlaid("check flat.toml"));
    let line = "#   a plane flow: the air is the same everywhere along z of the field\n";
    assert!(flat.contains(line) && !said.contains("a plane flow"), "{flat}");
    // A mesh of faces, too.
    let mesh = "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n\
        0 0 0 1 0 0 1 1 0 0 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\nPOINT_DATA 4\nVECTORS U double\n\
        0 -8 0 0 -8 0 0 -8 0 0 -8 0\nSCALARS k double 1\nLOOKUP_TABLE default\n1 1 1 1\n\
        SCALARS epsilon double 1\nLOOKUP_TABLE default\n9 9 9 9\n";
    std::fs::write(desk.path("flat.vtk"), mesh).unwrap();
    std::fs::write(desk.path("mesh.toml"), case.replace("duct.csv", "flat.vtk")).unwrap();
    let flat = success(&mut desk.spunlaid("check mesh.toml"));
    assert!(flat.contains(line), "{flat}");
    let said = success(&mut desk.with("check duct.toml", &["air.field_axis=z"]));
    assert!(said.contains("but the fibre hangs along z; write air.field_axis = \"-y\""), "{said}");
}

#[test]
fn check_remarks_on_rounded_elements_and_extrapolated_drag_once() {
    let desk = Desk::new();
    let mut command = desk.with("check brief.toml", &["fibre.element_length=33 mm", "fibre.diameter=5 um"]);
    let output = command.arg("--set").arg("run.time_step=1 us").output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    let note = "note: --set fibre.element_length = \"33 mm\" does not divide fibre.length into whole \
        elements: 6 of 33.33 mm are used";
    assert_eq!(said.matches(note).count(), 1, "{said}");
    assert_eq!(
        said.matches("warning: --set fibre.diameter = \"5 um\" is outside 13 µm to 390 µm").count(),
        1
    );
    assert_eq!(said.lines().count(), 2, "{said}");
}

/// The numbers of a line: what is reported is what the file says, and what follows from it.
#[test]
fn analytic_check_reports_the_numbers_of_a_web() {
    let desk = Desk::new();
    let web = "[fibre]\nlinear_density = \"2 dtex\"\ndensity = \"910 kg/m³\"\n[laydown]\n\
        sigma_md = \"18 mm\"\nsigma_cd = \"18 mm\"\nnoise = \"12 m^-0.5\"\n[line]\n\
        throughput = \"0.5 g/min\"\nbasis_weight = \"20 g/m²\"\nfilaments_per_metre = 5000\n[web]\n\
        width = \"0.5 m\"\nlength = \"0.5 m\"\n";
    std::fs::write(desk.path("web.toml"), web).unwrap();
    let said = success(&mut desk.spunlaid("check web.toml"));
    for part in [
        // 5000 × 0.5 g/min; 2500 g/min over 20 g/m²; 0.5 g/min over 2 dtex.
        "#   20 g/m² on a belt of 2.083 m/s: 150 kg/h from each metre of width\n",
        "#   5000 holes per metre of width, each with 0.5 g/min: filaments of 2 dtex, 16.73 µm, fed at 41.67 \
        m/s; 20 m of filament on each metre of belt\n",
        "#   500 mm wide and 500 mm long, 1000 × 1000 cells of 500 µm; 2500 filaments cross it\n",
        "#   nothing is simulated: the standard deviations and the noise are given\n",
        "#   the filaments are independent of each other, which gives a lower bound of the CV\n",
        "# expected, on ",
        "\n#   the web: about ",
        "\n#   advice, ",
        "# ready: spunlaid web web.toml\n",
        "basis_weight = \"0.02 kg/m²\"\n",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    // What it prints is a web that says the same.
    std::fs::write(desk.path("printed.toml"), &said).unwrap();
    assert_eq!(
        success(&mut desk.spunlaid("check printed.toml")),
        said.replace("web web.toml", "web printed.toml")
    );
    // Each point of a study has numbers of its own.
    let study = "web = 'web.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n\
        'line.basis_weight' = ['10 g/m²', '20 g/m²']\n";
    std::fs::write(desk.path("study.toml"), study).unwrap();
    let said = success(&mut desk.spunlaid("check study.toml"));
    assert!(said.contains("# 2 points of web.toml, each with 2 webs\n"), "{said}");
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<String> = said.lines().map(words).collect();
    for line in [
        "# 1 10 g/m² 10 g/m² 4.167 m/s 150 kg/h",
        "# 2 20 g/m² 20 g/m² 2.083 m/s 150 kg/h",
        "# ready: spunlaid sweep study.toml",
    ] {
        assert!(lines.iter().any(|said| said == line), "{line}\n{said}");
    }
}

/// Whether the air of the case is the same everywhere, and how all filaments fly in one.
#[test]
fn check_reports_in_which_air_the_filaments_of_a_web_hang() {
    let desk = Desk::with_case(FED);
    let web = "[laydown]\ncase = \"brief.toml\"\n[line]\nfilaments_per_metre = 1000\n[web]\n\
        width = \"0.5 m\"\nlength = \"0.5 m\"\n";
    std::fs::write(desk.path("web.toml"), web).unwrap();
    let said = success(&mut desk.spunlaid("check web.toml"));
    for part in [
        "#   brief.toml: its eddies lie in space (air.lateral = \"von-karman\")\n",
        // Eight in the length scale of the case, 16 mm.
        "#   250 filaments are simulated in shared turbulence, on a sheet of 500 mm × 500 mm; the web of 500 is \
        estimated from them (web.simulated)\n",
        "#   the field takes ",
        "\n#   the web: about ",
        "\n#   advice, ",
        "--set line.slot_gap=\"20 mm\"\n",
        "#   The force of the filaments on the air can be computed from the size of the slot: line.slot_gap",
        "fed at 50 m/s; 16.7 m of filament on each metre of belt",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    // As many as the file says, and all of them.
    let said = success(&mut desk.with("check web.toml", &["web.simulated=100", "line.slot_gap=20 mm"]));
    assert!(
        said.contains("#   50 filaments are simulated in shared turbulence, on a sheet of 500 mm × 500 mm;"),
        "{said}"
    );
    assert!(!said.contains("--set line.slot_gap"), "{said}");
    // 0.2316 mg/m · 50 m/s · 1000 beside 1.204 kg/m³ · 45 m/s · 20 mm, and 50/45 of that.
    let load = "# load on the air\n#   At the inlet the filaments have 1.1 % of the mass flow of the air and 1.2 % of \
        its momentum flux.\n";
    assert!(said.contains(load), "{said}");
    // Ten length scales of the air, for a web that is narrower.
    let narrow = ["web.width=0.1 m", "line.filaments_per_metre=5000"];
    let said = success(&mut desk.with("check web.toml", &narrow));
    assert!(
        said.contains(
            "#   80 filaments are simulated in shared turbulence, on a sheet of 160 mm × 500 mm; the web \
            of 500 is estimated"
        ),
        "{said}"
    );
    let together = desk.with("check web.toml", &["web.simulated=all"]).output().unwrap();
    let said = String::from_utf8(together.stdout).unwrap();
    assert!(
        said.contains(
            "#   all 500 filaments are simulated in shared turbulence, so neighbours land together\n"
        ),
        "{said}"
    );
    // What charge does is estimated, and warned of: 0.2316 mg/m · 5000 · 50/45 times 20 µC/g over 2 ε₀, and 20 µC/g of
    // that over 9.81 m/s².
    assert!(!said.contains("charged"), "{said}");
    let charged = ["line.filaments_per_metre=5000", "line.charge=20 µC/g"];
    let output = desk.with("check web.toml", &charged).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let estimate = "#   charged with 20 µC/g: about 1.5 MV/m at the edge of the curtain, which pulls at a filament \
        with 2962 times its weight; air breaks down at 3 MV/m\n";
    assert!(said.contains(estimate), "{said}");
    let warned = String::from_utf8(output.stderr).unwrap();
    assert!(warned.contains("line.charge = 20 µC/g gives a field of about 1.5 MV/m"), "{warned}");
}
