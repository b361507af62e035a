//! Files that scenes name.

use super::*;

/// The number of times that the test's files were read.
static COUNT: AtomicUsize = AtomicUsize::new(0);
static FORMAT: FileFormat = FileFormat {
    name: "a file of bytes",
    extensions: &["counted"],
    max_bytes: 16,
    read: |bytes| {
        COUNT.fetch_add(1, Ordering::Relaxed);
        Ok(bytes.iter().map(|byte| f32::from(*byte)).collect())
    },
    shipped: &[],
};

#[test]
fn every_file_is_read_once_however_often_it_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a.counted", "b.counted"] {
        std::fs::write(folder.path().join(name), name).expect("written");
    }
    let named = |name: &str| NamedFile::named(name, folder.path(), &FORMAT);
    let files: Vec<_> = (0..20).map(|i| named(["a.counted", "b.counted"][i % 2])).collect();
    assert_eq!(COUNT.load(Ordering::Relaxed), 0, "naming a file does not read it");
    let before = files_read();
    read_all(files.iter()).expect("few");
    assert_eq!(COUNT.load(Ordering::Relaxed), 2);
    let after = files_read();
    assert!(after[0] >= before[0] + 2 && after[1] >= before[1] + 2, "{before:?} {after:?}");
    for (i, file) in files.iter().enumerate() {
        let first = file.numbers().and_then(|numbers| numbers.first().copied());
        assert_eq!(first, Some(f32::from([b'a', b'b'][i % 2])), "{i}");
    }
    std::fs::write(folder.path().join("a.counted"), "c").expect("written");
    assert!(files[0].read_again() && !files[2].read_again());
    assert_eq!(files[2].numbers().as_deref(), Some(&[f32::from(b'c')][..]));
}

#[cfg(unix)]
#[test]
fn a_file_with_many_names_is_read_once_and_counts_once() {
    static READ: AtomicUsize = AtomicUsize::new(0);
    static FORMAT: FileFormat = FileFormat {
        name: "a file of links",
        extensions: &["linked"],
        max_bytes: 16,
        read: |bytes| {
            READ.fetch_add(1, Ordering::Relaxed);
            match bytes {
                b"wrong" => Err(FileProblem { line: Some(1), message: "it is wrong".to_owned() }),
                _ => Ok(bytes.iter().map(|byte| f32::from(*byte)).collect()),
            }
        },
        shipped: &[],
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("one"), "12345678").expect("written");
    std::fs::write(at("other"), "12345678").expect("written");
    std::fs::write(at("bad"), "wrong").expect("written");
    std::fs::hard_link(at("one"), at("hard")).expect("linked");
    std::os::unix::fs::symlink("one", at("soft")).expect("linked");
    std::os::unix::fs::symlink("bad", at("worse")).expect("linked");
    let named = |names: &[&str]| -> Vec<_> {
        names.iter().map(|name| NamedFile::named(name, folder.path(), &FORMAT)).collect()
    };
    let files = named(&["one", "hard", "soft", "bad", "worse"]);
    read_within(files.iter(), 13, 8).expect("little");
    assert_eq!(READ.load(Ordering::Relaxed), 2);
    let same = |a: &NamedFile, b: &NamedFile| {
        let [a, b] = [a, b].map(|file| file.numbers().expect("numbers"));
        Arc::ptr_eq(&a, &b)
    };
    assert!(same(&files[0], &files[1]) && same(&files[0], &files[2]));
    assert_eq!(files[0].version(), files[2].version());
    for (file, name) in files[3..].iter().zip(["bad", "worse"]) {
        assert_eq!(file.problem(), Some(format!("{}:1: it is wrong", at(name).shown())));
    }
    // After a change each is read again, but kept once.
    std::fs::write(at("one"), "87654321").expect("written");
    assert!(files[..3].iter().all(NamedFile::read_again));
    assert!(same(&files[0], &files[1]) && same(&files[0], &files[2]));
    assert_eq!(files[0].numbers().expect("numbers")[0], f32::from(b'8'));
    // The wrong twin: two files of the same bytes are two.
    let two = named(&["one", "other"]);
    read_within(two.iter(), 16, 16).expect("little");
    assert_eq!(
        read_within(two.iter(), 15, 16),
        Err("names files of 1 MiB in total; at most 0 MiB are read".to_owned())
    );
    assert_eq!(
        read_within(two.iter(), 16, 15),
        Err("names files with more than 15 numbers in total, the most allowed".to_owned())
    );
}

#[test]
fn a_shipped_file_is_read_once_when_its_numbers_are_needed() {
    static READ: AtomicUsize = AtomicUsize::new(0);
    static FORMAT: FileFormat = FileFormat {
        name: "a counted file",
        extensions: &["shipped"],
        max_bytes: 8,
        read: |bytes| {
            READ.fetch_add(1, Ordering::Relaxed);
            Ok(bytes.iter().map(|&byte| f32::from(byte)).collect())
        },
        shipped: &[("one", Shipped::Bytes(&[1, 2]))],
    };
    let file = NamedFile::shipped("one", &FORMAT);
    assert_eq!(READ.load(Ordering::Relaxed), 0);
    assert_eq!(file.numbers().as_deref(), Some(&[1.0, 2.0][..]));
    assert_eq!((READ.load(Ordering::Relaxed), file.problem()), (1, None));
}
