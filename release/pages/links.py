"""Looks whether every link, picture and script of the built site is there: python links.py SITE

Links to other sites are left out, except where something would be loaded from there: the site needs no network.
"""

from __future__ import annotations

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The anchors of a page, its links, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        of = {name: value or "" for name, value in attributes}
        self.anchors |= {of[name] for name in ("id", "name") if name in of}
        if tag == "a" and "href" in of:
            self.links.append(of["href"])
        elif tag == "link" and "stylesheet" in of.get("rel", ""):
            self.loaded.append(of["href"])
        elif tag in ("img", "script", "iframe", "source") and "src" in of:
            self.loaded.append(of["src"])


def main() -> None:
    site = Path(sys.argv[1]).resolve()
    # The pages of rustdoc are looked at by rustdoc, and need the page from which they are built.
    files = [path for path in site.rglob("*.html") if "rust" not in path.relative_to(site).parts[:1]]
    pages = {path: Page(path.read_text("utf-8")) for path in files}
    wrong, count = [], 0
    for path, page in pages.items():
        is_error_page = path.name == "404.html"
        for link in page.links + page.loaded:
            parts = urlsplit(link)
            if parts.scheme == "data":
                continue
            if parts.scheme or parts.netloc:
                if link in page.loaded:
                    wrong.append(f"{path.relative_to(site)} loads {link}")
                continue
            count += 1
            to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            # The page for wrong addresses is shown at any depth, so its links begin with the root.
            if is_error_page:
                to = site / unquote(parts.path).lstrip("/")
            to = to / "index.html" if to.is_dir() else to
            if not to.exists():
                wrong.append(f"{path.relative_to(site)} leads to {link}, which is not there")
            elif parts.fragment and to in pages and unquote(parts.fragment) not in pages[to].anchors | {"__skip", "top"}:
                wrong.append(f"{path.relative_to(site)} leads to {link}, where there is no such place")
    print(f"{len(pages)} pages, {count} links, {len(wrong)} wrong")
    if wrong or not pages:
        raise SystemExit("\n".join(f"error: {line}" for line in sorted(wrong)))


if __name__ == "__main__":
    main()
