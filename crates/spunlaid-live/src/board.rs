//! The board between the flight and its pages: what all pages see, of which each gets the latest only, and
//! answers to one of them. The flight never waits for a page.

use super::frame::Frame;
use spunlaid::ground::threads::lock;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// Most pages at a time.
const PAGES: usize = 16;
/// Messages that wait for a page.
const WAITING: usize = 64;

/// Number of a page.
pub(super) type PageId = u64;

/// A text that all pages see, as JSON.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Topic {
    Settings,
    State,
    Statistics,
}

impl Topic {
    const ALL: [Self; 3] = [Self::Settings, Self::State, Self::Statistics];
}

/// Something for a page.
#[derive(Clone, Debug)]
pub(super) enum News {
    Text(Arc<str>),
    Frame(Arc<Frame>),
    /// A whole frame of the protocol, as the socket answers a ping.
    Raw(Vec<u8>),
    /// The page leaves.
    End,
}

/// What is shown, and how often it has changed.
#[derive(Debug)]
struct Notice<T> {
    latest: T,
    changes: u64,
}

impl<T> Notice<T> {
    fn show(&mut self, latest: T) {
        self.latest = latest;
        self.changes += 1;
    }
}

/// The changes that a page has had.
#[derive(Debug, Default)]
pub(super) struct Bookmark {
    texts: [u64; Topic::ALL.len()],
    frame: u64,
}

#[derive(Debug)]
struct Notices {
    texts: [Notice<Arc<str>>; Topic::ALL.len()],
    frame: Notice<Arc<Frame>>,
    /// What waits for each page.
    pages: BTreeMap<PageId, VecDeque<News>>,
    next_page: PageId,
}

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Board {
    notices: Mutex<Notices>,
    changed: Condvar,
}

impl Board {
    pub(super) fn new(frame: Frame) -> Self {
        let texts = Topic::ALL.map(|_| Notice { latest: "".into(), changes: 1 });
        let frame = Notice { latest: Arc::new(frame), changes: 1 };
        let notices = Notices { texts, frame, pages: BTreeMap::new(), next_page: 0 };
        Self { notices: Mutex::new(notices), changed: Condvar::new() }
    }

    /// The notices; they are whole even after a thread that had them has panicked.
    fn notices(&self) -> MutexGuard<'_, Notices> {
        lock(&self.notices)
    }

    /// Shows a text to all pages.
    pub(super) fn show_text(&self, topic: Topic, text: String) {
        self.notices().texts[topic as usize].show(text.into());
        self.changed.notify_all();
    }

    /// Whether a topic shows this text.
    pub(super) fn shows(&self, topic: Topic, text: &str) -> bool {
        *self.notices().texts[topic as usize].latest == *text
    }

    /// Shows a frame to all pages.
    pub(super) fn show_frame(&self, frame: Frame) {
        self.notices().frame.show(Arc::new(frame));
        self.changed.notify_all();
    }

    /// A place for a new page; `None` if too many are open.
    pub(super) fn open(&self) -> Option<PageId> {
        let mut notices = self.notices();
        let page = notices.next_page;
        if notices.pages.len() == PAGES {
            return None;
        }
        notices.next_page += 1;
        notices.pages.insert(page, VecDeque::new());
        Some(page)
    }

    /// Gives the place of a page back.
    pub(super) fn close(&self, page: PageId) {
        self.notices().pages.remove(&page);
        self.changed.notify_all();
    }

    /// Puts an answer up for a page. A page that does not fetch its answers misses them.
    pub(super) fn answer(&self, page: PageId, text: String) {
        if let Some(waiting) = self.notices().pages.get_mut(&page).filter(|waiting| waiting.len() < WAITING) {
            waiting.push_back(News::Text(text.into()));
        }
        self.changed.notify_all();
    }

    /// Puts something up for a page as soon as there is room; `false` if the page is closed.
    pub(super) fn post(&self, page: PageId, news: News) -> bool {
        let full = |notices: &mut Notices| notices.pages.get(&page).is_some_and(|all| all.len() >= WAITING);
        let notices = self.changed.wait_while(self.notices(), full);
        let mut notices = notices.unwrap_or_else(PoisonError::into_inner);
        let Some(waiting) = notices.pages.get_mut(&page) else { return false };
        waiting.push_back(news);
        self.changed.notify_all();
        true
    }

    /// Waits for something that a page has not had: what waits for it first, then texts, then the frame.
    pub(super) fn next(&self, page: PageId, mark: &mut Bookmark) -> News {
        let mut notices = self.notices();
        loop {
            let Some(waiting) = notices.pages.get_mut(&page) else { return News::End };
            if let Some(news) = waiting.pop_front() {
                self.changed.notify_all();
                return news;
            }
            for (notice, mark) in notices.texts.iter().zip(&mut mark.texts) {
                if *mark != notice.changes {
                    *mark = notice.changes;
                    return News::Text(Arc::clone(&notice.latest));
                }
            }
            if mark.frame != notices.frame.changes {
                mark.frame = notices.frame.changes;
                return News::Frame(Arc::clone(&notices.frame.latest));
            }
            notices = self.changed.wait(notices).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fibres::Fibres;
    use super::super::frame::RecentMotion;
    use super::*;
    use spunlaid::input::{read_case, starter_case};

    fn board() -> Board {
        let fibres = Fibres::new(read_case((starter_case(), "a.toml"), &[]).unwrap().0).unwrap();
        Board::new(Frame::new(fibres.snapshot(), &RecentMotion::new()))
    }

    fn text(news: News) -> String {
        let News::Text(text) = news else { panic!("{news:?}") };
        text.to_string()
    }

    #[test]
    fn a_page_gets_its_answers_first_and_the_latest_of_all_else() {
        let board = board();
        let (page, mut mark) = (board.open().unwrap(), Bookmark::default());
        for (topic, shown) in [(Topic::State, "old"), (Topic::State, "new"), (Topic::Settings, "keys")] {
            board.show_text(topic, shown.to_owned());
        }
        board.answer(page, "answer".to_owned());
        assert!(board.shows(Topic::State, "new") && !board.shows(Topic::State, "old"));
        let texts = [(); 4].map(|()| text(board.next(page, &mut mark)));
        assert_eq!(texts, ["answer", "keys", "new", ""]);
        assert!(matches!(board.next(page, &mut mark), News::Frame(_)));
        // Nothing comes twice.
        board.show_text(Topic::Statistics, "now".to_owned());
        assert_eq!(text(board.next(page, &mut mark)), "now");
    }

    #[test]
    fn a_page_that_fetches_nothing_misses_answers_and_a_closed_one_gets_nothing() {
        let board = board();
        let (page, mut mark) = (board.open().unwrap(), Bookmark::default());
        (0..2 * WAITING).for_each(|i| board.answer(page, i.to_string()));
        (0..WAITING).for_each(|i| assert_eq!(text(board.next(page, &mut mark)), i.to_string()));
        assert_eq!(text(board.next(page, &mut mark)), "");
        board.close(page);
        assert!(matches!(board.next(page, &mut mark), News::End));
        assert!(!board.post(page, News::End));
    }

    #[test]
    fn as_many_pages_as_there_are_places() {
        let board = board();
        let pages: Vec<PageId> = (0..PAGES).filter_map(|_| board.open()).collect();
        assert_eq!((pages.len(), board.open()), (PAGES, None));
        board.close(pages[3]);
        assert!(board.open().is_some_and(|page| !pages.contains(&page)));
    }
}
