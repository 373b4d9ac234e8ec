use super::*;

/// Numbers of each record, and its length in the log [bytes].
const NUMBERS: usize = 5;
const RECORD: usize = 8 * (5 + 1 + NUMBERS);

fn record(point: u64, replicate: u64) -> Record {
    let number = |i: usize| (point * 100 + replicate * 10) as f64 + i as f64 / 8.0;
    let measured = (0..NUMBERS).map(number).collect();
    Record { point, replicate, outcome: ReplicateOutcome::Measured(measured) }
}

fn header() -> Header {
    Header { version: "1.2.3".to_owned(), study: 0xdead_beef }
}

/// A journal of six records in a folder, closed again.
fn written() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    let (mut journal, found) = Journal::open(&path, false).unwrap();
    assert_eq!(found, None);
    journal.begin(&header()).unwrap();
    journal.add(&[record(0, 0), record(2, 1)]).unwrap();
    journal.add(&[record(1, 0), record(0, 1), record(2, 0), record(1, 1)]).unwrap();
    (folder, path)
}

fn reopened(path: &Path) -> (Journal, JournalState) {
    let (mut journal, found) = Journal::open(path, false).unwrap();
    assert_eq!(found, Some(header()));
    let found = journal.go_on(3, 2).unwrap();
    (journal, found)
}

#[test]
fn records_come_back_in_order_of_replicates() {
    let (_folder, path) = written();
    let (mut journal, found) = reopened(&path);
    assert_eq!(found, JournalState { fibres: 6, damaged: 0, torn: false });
    for point in 0..3 {
        assert_eq!(journal.records(point, 9).unwrap(), [record(point as u64, 0), record(point as u64, 1)]);
        assert_eq!(journal.records(point, 1).unwrap(), [record(point as u64, 0)]);
        assert_eq!(journal.held(point), 2);
        assert!(journal.holds(point, 1) && !journal.holds(point, 2));
    }
    let lost = Record { point: 0, replicate: 0, outcome: ReplicateOutcome::Lost { node: 7, time: 0.25 } };
    journal.begin(&header()).unwrap();
    journal.add(std::slice::from_ref(&lost)).unwrap();
    assert_eq!(journal.records(0, 1).unwrap(), [lost]);
}

#[test]
fn a_torn_tail_of_any_length_is_cut_off_and_added_to() {
    let (_folder, path) = written();
    let whole = std::fs::read(&path).unwrap();
    let start = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for length in start..whole.len() {
        std::fs::write(&path, &whole[..length]).unwrap();
        let (mut journal, found) = reopened(&path);
        assert_eq!(found.fibres as usize, (length - start) / RECORD);
        assert_eq!(found.torn, (length - start) % RECORD != 0);
        let lacking = [record(0, 0), record(2, 1), record(1, 0), record(0, 1), record(2, 0), record(1, 1)];
        journal.add(&lacking[found.fibres as usize..]).unwrap();
        drop(journal);
        assert!(std::fs::read(&path).unwrap() == whole, "cut at {length}");
    }
}

#[test]
fn a_header_cut_off_counts_as_none() {
    let (_folder, path) = written();
    let whole = std::fs::read(&path).unwrap();
    let start = whole.iter().position(|byte| *byte == b'\n').unwrap();
    for length in 0..start {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert_eq!(Journal::open(&path, false).unwrap().1, None);
    }
}

#[test]
fn a_flipped_bit_anywhere_costs_one_record() {
    let (_folder, path) = written();
    let whole = std::fs::read(&path).unwrap();
    let start = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for byte in start..whole.len() {
        let mut damaged = whole.clone();
        damaged[byte] ^= 1 << (byte % 8);
        std::fs::write(&path, &damaged).unwrap();
        let (mut journal, found) = reopened(&path);
        // A count that is damaged may make the last record look torn.
        assert_eq!((found.fibres, found.damaged + u64::from(found.torn)), (5, 1), "byte {byte}");
        // The lost record can be added again.
        let lost = [record(0, 0), record(2, 1), record(1, 0), record(0, 1), record(2, 0), record(1, 1)]
            [(byte - start) / RECORD]
            .clone();
        assert!(!journal.holds(lost.point as usize, lost.replicate));
        journal.add(&[lost]).unwrap();
        drop(journal);
        let (mut journal, found) = reopened(&path);
        assert_eq!(found.fibres, 6);
        assert_eq!(journal.records(1, 2).unwrap(), [record(1, 0), record(1, 1)]);
    }
}

#[test]
fn zeros_at_the_end_are_no_records() {
    let (_folder, path) = written();
    let whole = std::fs::read(&path).unwrap();
    let mut longer = whole.clone();
    longer.resize(whole.len() + 3 * RECORD, 0);
    std::fs::write(&path, longer).unwrap();
    let (_journal, found) = reopened(&path);
    assert_eq!(found, JournalState { fibres: 6, damaged: 1, torn: false });
    assert!(std::fs::read(&path).unwrap() == whole);
}

#[test]
fn records_of_points_that_are_not_there_do_not_count() {
    let (_folder, path) = written();
    let (mut journal, _) = Journal::open(&path, false).unwrap();
    assert_eq!(journal.go_on(2, 2).unwrap(), JournalState { fibres: 4, damaged: 2, torn: false });
}

#[test]
fn rejects_a_second_process() {
    let (_folder, path) = written();
    let (journal, _) = Journal::open(&path, false).unwrap();
    let refusal = Journal::open(&path, false).unwrap_err();
    assert!(refusal.to_string().contains("another spunlaid process is using this folder"), "{refusal}");
    drop(journal);
    Journal::open(&path, false).unwrap();
}

#[test]
fn rejects_other_files_and_other_formats() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    let refusal_of = |text: &[u8]| {
        std::fs::write(&path, text).unwrap();
        Journal::open(&path, false).unwrap_err()
    };
    for text in [
        &b"shopping list\n"[..],
        b"shopping list",
        &[0xff; 500],
        b"spunlaid-journal format=5 study=zz version=1\n",
    ] {
        let refusal = refusal_of(text);
        assert!(matches!(refusal, Error::Folder(_)));
        assert!(refusal.to_string().contains("is not the journal of a study"), "{refusal}");
    }
    let format = refusal_of(b"spunlaid-journal format=9 version=9.9.9 study=00000000\n");
    assert!(format.to_string().contains("format 9, but this spunlaid reads format 5"), "{format}");
    // Of a build whose identities nobody else can compute.
    let former = refusal_of(b"spunlaid-journal format=3 version=0.1.0 study=00000000\n").to_string();
    assert!(
        former.contains("format 3, but this spunlaid reads format 5; continue with the version"),
        "{former}"
    );
}

/// What another process holds is not removed, and what is removed is no obstacle whatever it was.
#[test]
fn a_fresh_journal_replaces_any_file_that_is_not_in_use() {
    let (_folder, path) = written();
    let (journal, _) = Journal::open(&path, false).unwrap();
    Journal::open(&path, true).unwrap_err();
    drop(journal);
    reopened(&path);
    std::fs::write(&path, "shopping list\n").unwrap();
    assert_eq!(Journal::open(&path, true).unwrap().1, None);
}
