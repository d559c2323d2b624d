"""A headless Chromium for tests of pages. It records the messages of the console and all requests."""
import json
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

MEASURE = """
const shown = e => e.getClientRects().length > 0;
const drawn = [...document.images].filter(shown).map(i => i.getBoundingClientRect().width / i.naturalWidth);
const sizes = [...document.querySelectorAll('p, td, th, figcaption, h1, h2, pre')].filter(shown)
  .map(e => parseFloat(getComputedStyle(e).fontSize));
const widths = [...document.querySelectorAll('p')].map(e => e.getBoundingClientRect().width);
return {window: innerWidth, content: document.documentElement.scrollWidth,
        broken: [...document.images].filter(i => !(i.complete && i.naturalWidth > 0)).length,
        drawn: Math.min(...drawn, 1), letters: Math.min(...sizes), paragraph: Math.max(...widths)};
"""


class Browser:
    def __init__(self):
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)

    def quit(self):
        self.driver.quit()

    def show(self, page: Path, width: int) -> dict:
        """Opens a page in a window of this width and returns measurements.

        The sizes of the window, the content, the smallest letters and the widest paragraph are in pixels. `drawn` is the smallest
        scale of a picture, and `broken` the number of pictures that were not loaded.
        """
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        self.console(), self.requests()
        self.driver.get(page.as_uri())
        return self.driver.execute_script(MEASURE)

    def console(self) -> list[str]:
        """Returns the messages of the console since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> list[str]:
        """Returns the addresses requested since the last call."""
        events = (json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance"))
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
