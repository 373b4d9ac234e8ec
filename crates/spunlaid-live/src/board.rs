//! The board between a session and its pages: what all pages see, of which each gets the latest only, and
//! answers to one of them. The session never waits for a page.

use spunlaid::ground::threads::lock;
use std::collections::{BTreeMap, VecDeque};
use std::fmt::Debug;
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
    /// What can be changed: the settings of a case, the knobs of a line.
    Keys,
    State,
    /// What was found so far: statistics of fibres, numbers of a web.
    Numbers,
}

impl Topic {
    const ALL: [Self; 3] = [Self::Keys, Self::State, Self::Numbers];
}

/// What pages see move.
pub(super) trait Picture: Debug + Send + Sync + 'static {
    /// How far a page is.
    type Had: Default;

    /// The binary messages for a page that has had so much.
    fn messages(&self, had: &mut Self::Had) -> Vec<Vec<u8>>;
}

/// Something for a page.
#[derive(Clone, Debug)]
pub(super) enum News<P> {
    Text(Arc<str>),
    Picture(Arc<P>),
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
    picture: u64,
}

#[derive(Debug)]
struct Notices<P> {
    texts: [Notice<Arc<str>>; Topic::ALL.len()],
    picture: Notice<Arc<P>>,
    /// What waits for each page.
    pages: BTreeMap<PageId, VecDeque<News<P>>>,
    next_page: PageId,
}

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Board<P> {
    notices: Mutex<Notices<P>>,
    changed: Condvar,
}

impl<P> Board<P> {
    pub(super) fn new(picture: P) -> Self {
        let texts = Topic::ALL.map(|_| Notice { latest: "".into(), changes: 1 });
        let picture = Notice { latest: Arc::new(picture), changes: 1 };
        let notices = Notices { texts, picture, pages: BTreeMap::new(), next_page: 0 };
        Self { notices: Mutex::new(notices), changed: Condvar::new() }
    }

    /// The notices; they are whole even after a thread that had them has panicked.
    fn notices(&self) -> MutexGuard<'_, Notices<P>> {
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

    /// Shows a picture to all pages.
    pub(super) fn show_picture(&self, picture: P) {
        self.notices().picture.show(Arc::new(picture));
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
    pub(super) fn post(&self, page: PageId, news: News<P>) -> bool {
        let full =
            |notices: &mut Notices<P>| notices.pages.get(&page).is_some_and(|all| all.len() >= WAITING);
        let notices = self.changed.wait_while(self.notices(), full);
        let mut notices = notices.unwrap_or_else(PoisonError::into_inner);
        let Some(waiting) = notices.pages.get_mut(&page) else { return false };
        waiting.push_back(news);
        self.changed.notify_all();
        true
    }

    /// Waits for something that a page has not had: what waits for it first, then texts, then the picture.
    pub(super) fn next(&self, page: PageId, mark: &mut Bookmark) -> News<P> {
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
            if mark.picture != notices.picture.changes {
                mark.picture = notices.picture.changes;
                return News::Picture(Arc::clone(&notices.picture.latest));
            }
            notices = self.changed.wait(notices).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board() -> Board<u8> {
        Board::new(7)
    }

    fn text(news: News<u8>) -> String {
        let News::Text(text) = news else { panic!("{news:?}") };
        text.to_string()
    }

    #[test]
    fn a_page_gets_its_answers_first_and_the_latest_of_all_else() {
        let board = board();
        let (page, mut mark) = (board.open().unwrap(), Bookmark::default());
        for (topic, shown) in [(Topic::State, "old"), (Topic::State, "new"), (Topic::Keys, "keys")] {
            board.show_text(topic, shown.to_owned());
        }
        board.answer(page, "answer".to_owned());
        assert!(board.shows(Topic::State, "new") && !board.shows(Topic::State, "old"));
        let texts = [(); 4].map(|()| text(board.next(page, &mut mark)));
        assert_eq!(texts, ["answer", "keys", "new", ""]);
        assert!(matches!(board.next(page, &mut mark), News::Picture(_)));
        // Nothing comes twice.
        board.show_text(Topic::Numbers, "now".to_owned());
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
