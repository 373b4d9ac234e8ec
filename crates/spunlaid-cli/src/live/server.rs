//! The server: hands out the page, and carries messages and frames between pages and the flight.

use super::guard::Guard;
use super::message::{self, Answer, Asked, LARGEST};
use super::page;
use super::session::{Ask, Page, Shown};
use axum::Router;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use axum::serve::ListenerExt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::{Semaphore, mpsc, oneshot};

/// Most pages at a time.
const PAGES: usize = 16;
/// A page that does not take a message within this time is given up; it may come back.
const PATIENCE: Duration = Duration::from_secs(10);
/// Answers that wait for a page.
const ANSWERS: usize = 64;

/// What all requests share.
struct Shared {
    guard: Guard,
    asks: mpsc::Sender<Ask>,
    shown: Shown,
    pages: Arc<Semaphore>,
    next_page: AtomicU64,
}

/// Serves until the flight has ended.
///
/// # Errors
/// The server cannot go on.
pub(super) async fn serve(
    listener: std::net::TcpListener,
    guard: Guard,
    asks: mpsc::Sender<Ask>,
    shown: Shown,
    ended: oneshot::Receiver<()>,
) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    // A small message leaves at once; otherwise it waits until the page has confirmed the last one, 40 ms and more.
    let listener = tokio::net::TcpListener::from_std(listener)?.tap_io(|stream| {
        // It then only comes later.
        let _ = stream.set_nodelay(true);
    });
    let pages = Arc::new(Semaphore::new(PAGES));
    let shared = Arc::new(Shared { guard, asks, shown, pages, next_page: AtomicU64::new(0) });
    let router = Router::new()
        .route("/{token}/", get(|| async { page::file("") }))
        .route("/{token}/flight", get(upgrade))
        .route(
            "/{token}/{file}",
            get(|Path((_, file)): Path<(String, String)>| async move { page::file(&file) }),
        )
        .layer(middleware::from_fn_with_state(Arc::clone(&shared), guarded))
        .with_state(shared);
    tokio::select! {
        served = axum::serve(listener, router) => served,
        _ = ended => Ok(()),
    }
}

/// Answers only what the guard lets pass, and adds what every answer says.
async fn guarded(State(shared): State<Arc<Shared>>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    let upgrades = headers.contains_key(header::UPGRADE);
    let (host, origin) = (only(headers, &header::HOST), only(headers, &header::ORIGIN));
    let two = headers.get_all(header::ORIGIN).iter().count() > 1;
    let passed = shared.guard.check(request.uri().path(), host, origin, upgrades || two);
    let mut response = match passed {
        Ok(()) => next.run(request).await,
        Err(refusal) => (StatusCode::FORBIDDEN, refusal.text()).into_response(),
    };
    response.headers_mut().extend(page::headers());
    response
}

/// The text of a header that is there once.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut all = headers.get_all(name).iter();
    let first = all.next()?.to_str().ok()?;
    all.next().is_none().then_some(first)
}

async fn upgrade(State(shared): State<Arc<Shared>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(place) = Arc::clone(&shared.pages).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "Too many pages are open; close one.\n").into_response();
    };
    upgrade.max_message_size(LARGEST).max_frame_size(LARGEST).on_upgrade(move |socket| async move {
        let page = shared.next_page.fetch_add(1, Ordering::Relaxed);
        let (answers, heard) = mpsc::channel(ANSWERS);
        let look = |visible| Ask { from: page, asked: Asked::Look { visible }, answers: answers.clone() };
        if shared.asks.send(look(true)).await.is_ok() {
            // However the talk ends, the page is gone.
            let _ = talk(socket, page, &shared, answers.clone(), heard).await;
            let _ = shared.asks.send(look(false)).await;
        }
        drop(place);
    })
}

/// Talks with a page until one of both has had enough.
async fn talk(
    mut socket: WebSocket,
    page: Page,
    shared: &Shared,
    answers: mpsc::Sender<String>,
    mut heard: mpsc::Receiver<String>,
) -> Option<()> {
    let Shown { mut frame, texts: [mut settings, mut state, mut statistics] } = shared.shown.clone();
    let mut had = Default::default();
    for latest in [&mut settings, &mut state, &mut statistics] {
        let text = latest.borrow_and_update().as_ref().clone();
        send(&mut socket, Message::text(text)).await?;
    }
    frame.mark_changed();
    loop {
        let message = tokio::select! {
            biased;
            asked = socket.recv() => {
                match asked?.ok()? {
                    Message::Text(text) => match message::read(&text) {
                        Ok(asked) => {
                            shared.asks.send(Ask { from: page, asked, answers: answers.clone() }).await.ok()?;
                            continue;
                        }
                        Err(answer) => Message::text(answer.json()),
                    },
                    Message::Binary(_) => Message::text(Answer::refused("messages are text").json()),
                    Message::Close(_) => return None,
                    Message::Ping(_) | Message::Pong(_) => continue,
                }
            }
            answer = heard.recv() => Message::text(answer?),
            changed = settings.changed() => Message::text(changed.ok().map(|()| settings.borrow_and_update().as_ref().clone())?),
            changed = state.changed() => Message::text(changed.ok().map(|()| state.borrow_and_update().as_ref().clone())?),
            changed = statistics.changed() => Message::text(changed.ok().map(|()| statistics.borrow_and_update().as_ref().clone())?),
            changed = frame.changed() => {
                changed.ok()?;
                let latest = Arc::clone(&frame.borrow_and_update());
                Message::binary(latest.bytes(&mut had))
            }
        };
        send(&mut socket, message).await?;
    }
}

/// Sends a message; `None` if the page does not take it.
async fn send(socket: &mut WebSocket, message: Message) -> Option<()> {
    tokio::time::timeout(PATIENCE, socket.send(message)).await.ok()?.ok()
}
