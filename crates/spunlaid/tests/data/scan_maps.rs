//! Maps with the numbers of their rows and columns beside them, as pandas and others write them.

use spunlaid_web::scan::{analyse, parse};
use spunlaid_web::{Light, Settings};

/// A measured map of 60 × 50 pixels; its CV over patches of 4 mm is 0.09412.
const MAP: &str = include_str!("../scan_fixtures/map.csv");

/// The CV over patches of 4 mm, and whether rows and columns were numbered.
fn found(text: &str) -> (f64, [bool; 2]) {
    let picture = parse(text.as_bytes(), "a", 2e-3).unwrap();
    let settings = Settings::new(Light::Weight { mean: None });
    let found = analyse(&picture, &Settings { patches: vec![4e-3], ..settings }).unwrap();
    let is_reported = found.notes.iter().any(|note| note.to_string().ends_with("left out of the map"));
    assert_eq!(is_reported, picture.numbered.contains(&true));
    (found.patches[0].patch_cv.cv, picture.numbered)
}

/// The map with a row of heads, and a column that begins with its corner.
fn numbered(
    corner: Option<&str>,
    head: Option<&dyn Fn(usize) -> String>,
    row: &dyn Fn(usize) -> String,
) -> String {
    let mut lines: Vec<String> = MAP.lines().map(str::to_owned).collect();
    if let Some(corner) = corner {
        lines.iter_mut().enumerate().for_each(|(i, line)| *line = format!("{},{line}", row(i)));
        if let Some(head) = head {
            lines.insert(0, (0..50).fold(corner.to_owned(), |line, i| line + "," + &head(i)));
        }
    } else if let Some(head) = head {
        lines.insert(0, (0..50).map(head).collect::<Vec<_>>().join(","));
    }
    lines.join("\n")
}

#[test]
fn numbers_of_rows_and_columns_are_no_map() {
    let plain = |i: usize| i.to_string();
    let from_one = |i: usize| (i + 1).to_string();
    let named = |i: usize| format!("x{i}");
    let place = |i: usize| format!("{:.3}", 2.0 / 3.0 * i as f64);
    let falling = |i: usize| (60 - i).to_string();
    let mixed_up = |i: usize| ((i * 7) % 60).to_string();
    for (name, text, wanted) in [
        ("none", MAP.to_owned(), [false, false]),
        ("index and heads", numbered(Some(""), Some(&plain), &plain), [true, true]),
        ("from one", numbered(Some(""), Some(&from_one), &from_one), [true, true]),
        ("places", numbered(Some(""), Some(&place), &place), [true, true]),
        ("a corner with a number", numbered(Some("50"), Some(&place), &place), [true, true]),
        ("an index in disorder", numbered(Some(""), Some(&plain), &mixed_up), [true, true]),
        ("named heads", numbered(Some(""), Some(&named), &plain), [true, false]),
        ("a named index", numbered(Some("row"), Some(&plain), &plain), [true, false]),
        ("a falling index", numbered(Some("y"), Some(&named), &falling), [true, false]),
        ("no heads", numbered(Some(""), None, &plain), [true, false]),
        ("no index", numbered(None, Some(&plain), &plain), [false, true]),
        (
            "decimal commas",
            numbered(Some(""), Some(&plain), &plain).replace(',', ";").replace('.', ","),
            [true, true],
        ),
    ] {
        let (cv, numbered) = found(&text);
        assert!((cv - 0.09412).abs() < 5e-6, "{name}: {cv}");
        // Heads that are names are none of the rows.
        assert_eq!(numbered, wanted, "{name}");
    }
}

#[test]
fn a_map_keeps_its_first_row_and_column() {
    let text = |value: &dyn Fn(usize, usize) -> f64| -> String {
        (0..20)
            .map(|y| (0..18).map(|x| value(x, y).to_string()).collect::<Vec<_>>().join(",") + "\n")
            .collect()
    };
    for (name, value) in [
        (
            "a slope",
            &(|x: usize, y: usize| 14.0 + 0.1 * x as f64 + 0.2 * y as f64) as &dyn Fn(usize, usize) -> f64,
        ),
        ("a slope along", &|_, y| 14.0 + y as f64),
        ("whole numbers", &|x, y| (10 + (x * x + 3 * y * y + x * y) % 7) as f64),
        ("an even edge", &|x, y| if x == 0 { 12.0 } else { 12.0 + ((x * y) % 5) as f64 }),
        ("a step beside an even column", &|x, y| {
            if x < 2 { y as f64 + 1.0 } else { 9.0 + ((x * y) % 5) as f64 }
        }),
    ] {
        let picture = parse(text(value).as_bytes(), "a", 2e-3).unwrap();
        assert_eq!((picture.columns, picture.rows, picture.numbered), (18, 20, [false; 2]), "{name}");
    }
    // Too few rows to decide.
    let short = MAP.lines().take(16).collect::<Vec<_>>().join("\n");
    assert_eq!(parse(short.as_bytes(), "a", 2e-3).unwrap().rows, 16);
}

/// The names of the columns have none for those of the rows before them: `DataFrame.to_string` of pandas 2,
/// and `write.table` of R 4.
#[test]
fn a_line_of_heads_that_lacks_its_corner_is_read() {
    let wanted = found(MAP).0;
    let rows = |name: &dyn Fn(usize) -> String, sign: &str| -> String {
        let row = |(i, line): (usize, &str)| format!("{}{sign}{}\n", name(i), line.replace(',', sign));
        MAP.lines().enumerate().map(row).collect()
    };
    let heads = |name: &dyn Fn(usize) -> String, sign: &str| (0..50).map(name).collect::<Vec<_>>().join(sign);
    let plain = |i: usize| i.to_string();
    let of_pandas = format!("    {}\n{}", heads(&plain, "      "), rows(&plain, "  "));
    let quoted = |i: usize| format!("\"{}\"", i + 1);
    let of_r =
        |sign: &str| format!("{}\n{}", heads(&|i| format!("\"V{}\"", i + 1), sign), rows(&quoted, sign));
    for text in [of_pandas, of_r(" "), of_r("\t"), of_r(",")] {
        assert_eq!(found(&text), (wanted, [true, false]), "{}", &text[..80]);
    }
}

/// Positions beside a map give the sides of its cells, in whatever order they stand; cells that are not square are
/// refused. Numbers of rows beside positions of columns give nothing.
#[test]
fn analytic_positions_beside_a_map_tell_the_sides_of_its_cells() {
    let sides = |corner: &str, across: f64, along: f64| {
        let head: Vec<String> = (0..40).map(|x| format!("{}", across * f64::from(x))).collect();
        let row = |y: u32| {
            let values: Vec<String> = (0..40).map(|x| format!("{}", 14 + (x * x + 3 * x * y) % 5)).collect();
            format!("{},{}\n", along * f64::from(y), values.join(","))
        };
        let text = format!("{corner},{}\n{}", head.join(","), (0..40).map(row).collect::<String>());
        parse(text.as_bytes(), "gauge.csv", None)
            .map(|picture| picture.pixel)
            .map_err(|error| error.to_string())
    };
    for (corner, across, along, wanted) in
        [("mm", 2.0, 2.0, 2e-3), ("mm", 5.0, -5.0, 5e-3), ("cm", 1.0, 1.0, 1e-2), ("y [m]", 0.5, 0.5, 0.5)]
    {
        let found = sides(corner, across, along).unwrap();
        assert!((found / wanted - 1.0).abs() < 1e-12, "{corner} {across}: {found}");
    }
    for (corner, across, along) in [("mm", 2.0, 4.0), ("mm", 1.0, 4.0), ("place", 2.0, 4.0), ("", 3.0, -2.5)]
    {
        let said = sides(corner, across, along).unwrap_err();
        assert!(
            said.contains("wide and") && said.contains("square cells"),
            "{corner} {across} {along}: {said}"
        );
    }
    let said = sides("", 2.0, 1.0).unwrap_err();
    assert!(said.contains("does not say how large its pixels are"), "{said}");
}

/// A row for each point, in any order and with some missing, is the map that has a line for each row.
#[test]
fn identical_a_table_of_points_is_its_map() {
    let weight = |x: u32, y: u32| f64::from(14 + (x * x + 3 * x * y) % 5);
    let (columns, rows) = (40, 30);
    let table = |step: [f64; 2], head: &str, order: u32, left_out: u32| {
        let count = columns * rows;
        let line = |i: u32| {
            let at = i * order % count;
            let (x, y) = (at % columns, at / columns);
            let [across, along] = [step[0] * f64::from(x) - 7.0, step[1] * f64::from(y)];
            format!("{across},{along},{}\n", weight(x, y))
        };
        let text = (0..count).filter(|i| *i != left_out).map(line).collect::<String>();
        parse(format!("{head}\n{text}").as_bytes(), "gauge.csv", None).map_err(|error| error.to_string())
    };
    for (head, pixel, order) in [("x_mm,y_mm,weight_g_m2", 2e-3, 1), ("x [cm],y [cm],weight", 2e-2, 7)] {
        let found = table([2.0, 2.0], head, order, u32::MAX).unwrap();
        assert_eq!([found.columns, found.rows], [columns, rows].map(|side| side as usize), "{head}");
        assert!((found.pixel / pixel - 1.0).abs() < 1e-12, "{head}: {}", found.pixel);
        for (at, value) in (0..).zip(&found.values) {
            assert_eq!(*value, weight(at % columns, at / columns), "{head} {at}");
        }
        let missing = table([2.0, 2.0], head, order, 100).unwrap();
        assert_eq!(missing.values.iter().filter(|value| value.is_nan()).count(), 1, "{head}");
    }
    let said = table([2.0, 3.0], "x_mm,y_mm,weight_g_m2", 1, u32::MAX).unwrap_err();
    assert!(said.contains("2 mm wide and 3 mm high"), "{said}");
    let text: String = (0..400).map(|i| format!("{},{},{i}\n", i * i % 397, i * 31 % 389)).collect();
    let said = parse(format!("x,y,g\n{text}").as_bytes(), "gauge.csv", 1e-3).unwrap_err().to_string();
    assert!(
        said.contains("not a structured grid of square cells") && said.contains("a line for each row"),
        "{said}"
    );
}
