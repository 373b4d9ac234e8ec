"""Makes live_line.webp, live.webp and report.png: what the pages of the program show, in a browser without a window.

    pip install playwright pillow
    python docs/images/recordings.py target/release/spunlaid line.toml cases/table1.toml results/table1/report.html \\
      docs/images

with the line and the report of the commands in the README. Chromium is looked for under the names in BROWSERS. The numbers of
the recordings, as in docs/live.md, are printed.
"""

import io
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

BROWSERS = ["chromium", "chromium-browser", "google-chrome"]
MARGIN = 16
"""Around what is shown of a report [px]."""
LONG = 600_000
"""What a page may take [ms]."""


class Live:
    """A page of `spunlaid live`, and the pictures of it. The program ends with it."""

    def __init__(self, browser, program, case, width, height):
        case = Path(case).resolve()
        command = [Path(program).resolve(), "live", case.name, "--no-open"]
        self.page = browser.new_page(viewport={"width": width, "height": height}, bypass_csp=True)
        self.pictures = []
        self.times = []
        self.process = subprocess.Popen(command, cwd=case.parent, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        try:
            self.page.goto(self.process.stdout.readline().strip())
            self.until("window.spunlaidLive?.seen.drawn > 0")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.page.close()

    def until(self, what):
        self.page.wait_for_function(what, timeout=LONG)

    def take(self, time):
        """Takes a picture, which is shown for so long [ms]."""
        self.pictures.append(picture_of(self.page.screenshot()))
        self.times.append(time)

    def amplitude(self):
        """The amplitude of the fibres in y [mm], with its standard error."""
        return self.page.evaluate("spunlaidLive.measured.numbers[0]")

    def slide(self, slider, notch):
        move = """(slider, notch) => {
            slider.value = notch;
            slider.dispatchEvent(new Event('input', { bubbles: true }));
        }"""
        self.page.locator(slider).evaluate(move, notch)

    def save(self, path, quality):
        first, *others = self.pictures
        first.save(path, save_all=True, append_images=others, duration=self.times, loop=0, quality=quality, method=6)


def picture_of(png):
    return Image.open(io.BytesIO(png)).convert("RGB")


def record_line(browser, program, line, path):
    """The gap of the slot becomes larger: before, first numbers, complete."""
    with Live(browser, program, line, width=1200, height=750) as live:
        live.until("spunlaidLive.judged?.before?.is_complete")
        live.take(3000)
        slider = '[data-knob="slot_gap"] input[type=range]'
        from_notch = int(live.page.locator(slider).input_value())
        for step in range(1, 7):
            live.slide(slider, from_notch + 15 * step)
            live.take(120)
        live.until("spunlaidLive.judged?.change && spunlaidLive.state.now !== spunlaidLive.state.pinned")
        live.take(3000)
        live.until("spunlaidLive.judged?.now?.is_complete && spunlaidLive.judged.of === spunlaidLive.state.generation")
        live.take(5000)
        print(live.page.locator("#headline").inner_text(), "|", live.page.locator("#change").inner_text())
        live.save(path, quality=60)


def record_fibre(browser, program, case, path):
    """The air of the fibre of Table 1 becomes twice as fast."""
    with Live(browser, program, case, width=1000, height=860) as live:
        live.until("spunlaidLive.measured?.duration >= 20")
        print(live.amplitude())
        pace = live.page.locator("#pace")
        pace.select_option("tenth")
        for frame in range(60):
            if frame == 20:
                velocity = live.page.locator('input[data-key="air.velocity"]:not([type=range])')
                velocity.fill("20 m/s")
                velocity.press("Enter")
            live.take(100)
            if frame == 40:
                pace.select_option("real")
                live.until("spunlaidLive.measured?.duration >= 10")
                print(live.amplitude())
                pace.select_option("tenth")
        live.save(path, quality=40)


def draw_report(browser, report, path):
    """The moving fibre of a report at one instant, with the other replicates."""
    page = browser.new_page(viewport={"width": 1500, "height": 1000})
    page.goto(Path(report).resolve().as_uri())
    page.locator("#ghosts").check()
    page.get_by_role("button", name="Pause").click()
    page.locator("#scrub").fill("0.642")
    stage = page.locator("#motion .stage").bounding_box()
    corner = {"x": stage["x"] - MARGIN, "y": stage["y"] - MARGIN}
    size = {side: stage[side] + 2 * MARGIN for side in ["width", "height"]}
    page.screenshot(path=path, full_page=True, clip=corner | size)


def main(program, line, case, report, folder):
    folder = Path(folder)
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        sys.exit(f"there is no Chromium: none of {', '.join(BROWSERS)}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found)
        record_line(browser, program, line, folder / "live_line.webp")
        record_fibre(browser, program, case, folder / "live.webp")
        draw_report(browser, report, folder / "report.png")


if __name__ == "__main__":
    main(*sys.argv[1:])
