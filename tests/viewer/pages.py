"""What the viewer shows: a page of a browser, and the pixels on it."""

from io import BytesIO

import numpy as np
from PIL import Image

from trihex.areas import Tessellation

# Milliseconds; a busy machine may need many.
PATIENCE = 180_000
APP = "document.querySelector('#trihex').app"


class Shown:
    """A page with the viewer; everything asked of it is what a user sees, but for the place of cells on the canvas."""

    def __init__(self, page, artefacts=None):
        self.page = page
        self.artefacts = artefacts
        self.faults = []
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("console", lambda line: self.faults.append(line.text) if line.type == "error" else None)

    def wait(self, condition):
        """Wait until a condition on `app` holds."""
        self.page.wait_for_function(f"() => {{ const app = {APP}; return app && ({condition}) }}", timeout=PATIENCE)

    def ask(self, expression):
        return self.page.evaluate(f"() => {{ const app = {APP}; return {expression} }}")

    def press(self, name, **more):
        self.page.get_by_role("button", name=name, exact=True, **more).click()

    def text(self, selector):
        return self.page.locator(selector).first.inner_text()

    def table(self):
        """Return the rows of the table of results: label, then a text for each plan."""
        rows = self.page.locator(".results tbody tr").all()
        return {row.locator("th").inner_text(): row.locator("td").all_inner_texts() for row in rows}

    def view(self, pane=0):
        """Return pixels per edge step and the place of the north-west corner, in pixels of the window."""
        self.draw()  # words that have just been said may need another line, which moves the picture
        scale, left, top, ratio, x, y = self.ask(
            f"((pane) => {{ const box = pane.canvas.getBoundingClientRect(), {{ scale, left, top }} = pane.view; "
            f"return [scale, left, top, box.width / pane.canvas.width, box.left, box.top] }})(app.panes[{pane}])"
        )
        return scale * ratio, left * ratio + x, top * ratio + y

    def place(self, x, y, pane=0):
        """Return where the centre of cell (x, y) is in the window."""
        scale, left, top = self.view(pane)
        shape = self.ask(f"app.panes[{pane}].doc.header.tessellation")
        cx, cy = Tessellation(shape).centre_of_cell(x, y)
        return cx * scale + left, cy * scale + top

    def click(self, x, y):
        self.page.mouse.click(*map(float, self.place(x, y)))

    def drag(self, cells):
        first, *rest = [tuple(map(float, self.place(*cell))) for cell in cells]
        self.page.mouse.move(*first)
        self.page.mouse.down()
        for point in rest:
            self.page.mouse.move(*point, steps=3)
        self.page.mouse.up()

    def draw(self):
        """Wait until the page is laid out and drawn."""
        self.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def pixels(self):
        """Return what the window shows, shape (height, width, 3)."""
        self.draw()
        return np.asarray(Image.open(BytesIO(self.page.screenshot())).convert("RGB"))

    def colours(self, pane=0, shift=(0, 0)):
        """Return the colours at the centres of all cells, moved by `shift` edge steps, shape (height, width, 3)."""
        height, width = self.ask(f"[app.panes[{pane}].doc.height, app.panes[{pane}].doc.width]")
        y, x = np.mgrid[:height, :width]
        px, py = self.place(x, y, pane)
        scale = self.view(pane)[0]
        return self.pixels()[(py + shift[1] * scale).astype(int), (px + shift[0] * scale).astype(int)]

    def keep(self, name):
        """Keep a screenshot to be looked at."""
        self.artefacts.mkdir(exist_ok=True)
        self.page.screenshot(path=self.artefacts / f"{name}.png")


def is_near(colours, colour, tolerance=6):
    """Tell where `colours` are `colour`, as the eye sees it."""
    return (np.abs(colours.astype(int) - np.array(colour)) <= tolerance).all(axis=-1)
