"""A browser, and the viewer in it.

Any Chrome or Chromium will do; where there is none these tests are left out and say so, but in CI that is a failure.
Screenshots are kept in ``artefacts/``, to be looked at.
"""

import os
import shutil
from pathlib import Path

import pytest

from tests.viewer.pages import PATIENCE, Shown
from trihex.viewer.desk import Desk
from trihex.viewer.folder import Folder
from trihex.viewer.server import make_viewing

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge")
PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
)
# Software drawing only, and nothing that calls home.
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
ARTEFACTS = Path(__file__).parents[2] / "artefacts"


def find_browser():
    """Return the path of a Chrome or Chromium, or None."""
    found = [shutil.which(name) for name in NAMES] + [place for place in PLACES if Path(place).exists()]
    return next((path for path in found if path), None)


@pytest.fixture(scope="module")
def browser():
    """A browser for the tests of one file; playwright's event loop must not outlive them."""
    path = find_browser()
    if path is None:
        reason = "no Chrome or Chromium on this machine: the viewer is not tested in a browser"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS), timeout=PATIENCE)
        yield browser
        browser.close()


@pytest.fixture
def open_viewer(browser, tmp_path):
    """Open the viewer in a new window: call it with what is shown first, and with options of the window.

    The page asks for what is `asked` by itself. Where a `script` runs before it, nobody waits for the document.
    """
    closing = []

    def open_it(first=None, asked=None, script=None, **window):
        desk = Desk(Folder(tmp_path), asked)
        viewing = make_viewing(desk, None if first is None else desk.show(first))
        running = viewing.running()
        running.__enter__()
        context = browser.new_context(**{"viewport": {"width": 1280, "height": 800}, **window})
        closing.append((context, running))
        shown = Shown(context.new_page(), ARTEFACTS)
        if script:
            shown.page.add_init_script(script)
        shown.page.goto(viewing.address)
        if not script:
            shown.wait("app.doc && !app.job")
        return shown

    yield open_it
    for context, running in closing:
        context.close()
        running.__exit__(None, None, None)
