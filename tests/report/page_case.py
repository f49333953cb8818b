"""What tests that look at a page in a browser share."""

from __future__ import annotations

import json
import sys
import unittest
from functools import cache
from pathlib import Path

from browser import Browser, find_browser

SKIPPED = 77  # what ctest takes for a skipped test

# Pixels of the canvas of panel k, by way of a copy, so that reading them does not change how it draws.
PIXELS = """((canvas) => {
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  return copy.getImageData(0, 0, canvas.width, canvas.height).data;
})(app.panels[%d].canvas)"""

# How many differ from the corner, which nothing is drawn over, and all as one number.
PICTURE = """((data) => {
  const words = new Uint32Array(data.buffer);
  let drawn = 0, hash = 0;
  for (const word of words) { drawn += word !== words[0]; hash = (31 * hash + word) >>> 0; }
  return {drawn, hash, corner: data[0]};
})(%s)"""

# How many have about the colour of references, which no colour map has in light mode.
REDS = """((data) => {
  let found = 0;
  for (let at = 0; at < data.length; at += 4) found += data[at] > 200 && data[at + 1] < 90 && data[at + 2] < 90;
  return found;
})(%s)"""


@cache
def the_browser() -> Browser:
    """One for all tests: its start takes longer than most of them."""
    return unittest.enterModuleContext(Browser())


class PageTest(unittest.TestCase):
    """Every test opens its page anew, in the one browser, and fails if the console complains."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.browser = the_browser()

    def open(self, page: Path, **how: object) -> None:
        self.browser.complaints.clear()
        self.browser.open(page, **how)
        self.addCleanup(lambda: self.assertEqual([], self.browser.complaints))

    def js(self, script: str) -> object:
        return self.browser.run(script)

    def choose(self, control: str, value: str, event: str = "change") -> None:
        self.js(f"{{const c = document.getElementById('{control}'); c.value = {json.dumps(value)};"
                f"c.dispatchEvent(new Event('{event}', {{bubbles: true}}));}}")
        self.browser.settle()

    def click(self, selector: str) -> None:
        self.js(f"document.querySelector({json.dumps(selector)})"
                ".dispatchEvent(new MouseEvent('click', {bubbles: true}))")
        self.browser.settle()

    def picture(self, k: int = 0) -> dict[str, int]:
        return self.js(PICTURE % (PIXELS % k))

    def reds(self) -> int:
        return self.js(REDS % (PIXELS % 0))

    def text(self, selector: str) -> str:
        return self.js(f"document.querySelector({json.dumps(selector)}).textContent")


def main() -> None:
    if find_browser() is None:
        print("Skipped: there is no chromium to open pages with. It comes with the package chromium (tools/packages).")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
