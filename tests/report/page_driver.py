"""A report page in headless Chromium, as a reader uses it."""
import base64
import pathlib
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

CHROMIUM = "/usr/bin/chromium"
DRIVER = "/usr/bin/chromedriver"
PATIENCE_S = 20


def start_browser():
    options = Options()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,900"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


class Page:
    """An open report."""

    def __init__(self, browser, file, place=""):
        self.browser = browser
        browser.get("about:blank")  # or a change of the fragment alone would not load the page anew
        browser.get(pathlib.Path(file).as_uri() + place)
        self.wait(lambda: self.script("return document.documentElement.dataset.ready") == "yes", "the page is not ready")

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def wait(self, condition, complaint):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(complaint + "; the browser says: " + repr(self.errors()))
            time.sleep(0.05)

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector):
        return self.script("return document.querySelector(arguments[0]).textContent", selector)

    def click(self, selector):
        self.script("arguments[0].scrollIntoView({block: 'center'})", self.one(selector))
        self.one(selector).click()

    def press(self, key):
        self.one("body").send_keys(key)

    def enter(self, selector, value):
        """Sets a form field as typing or dragging does."""
        self.script("const field = arguments[0]; field.value = arguments[1];"
                    "for (const type of ['input', 'change']) field.dispatchEvent(new Event(type, {bubbles: true}));",
                    self.one(selector), value)

    def table(self, section):
        """Rows of the section's first table as {column key: text}."""
        return self.script("""
          const table = document.querySelector(arguments[0] + " table");
          const keys = [...table.tHead.rows[0].cells].map((cell) => cell.dataset.key);
          return [...table.tBodies[0].rows].map((row) => Object.fromEntries([...row.cells].map((cell, i) => [keys[i], cell.textContent])));
        """, section)

    def open_cell(self):
        return self.script("return document.querySelector('.viewer').dataset.ready")

    def label(self, stage=0):
        return self.all(".stage .label")[stage].text

    def brightness(self, stage=0):
        """Mean 8-bit value of a stage's picture."""
        return self.script("""
          const canvas = document.querySelectorAll(".stage canvas")[arguments[0]];
          const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
          let sum = 0;
          for (let i = 0; i < data.length; i += 4) sum += data[i] + data[i + 1] + data[i + 2];
          return sum / (data.length / 4 * 3);
        """, stage)

    def pixel(self, x, y, width, height):
        """What the viewer prints of a pixel of the picture when it is pointed at."""
        self.script("""
          const canvas = document.querySelector(".stage canvas"), box = canvas.getBoundingClientRect();
          const [x, y, width, height] = arguments;
          canvas.dispatchEvent(new PointerEvent("pointermove", {bubbles: true,
            clientX: box.left + (x + 0.5) / width * box.width, clientY: box.top + (y + 0.5) / height * box.height}));
        """, x, y, width, height)
        return self.text(".pixel")

    def errors(self):
        return [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]

    def screenshot(self, file, width=1280):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        time.sleep(0.3)
        height = self.script("return document.documentElement.scrollHeight")
        clip = {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}
        picture = self.browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
        pathlib.Path(file).write_bytes(base64.b64decode(picture["data"]))
        scroll_width = self.script("return document.documentElement.scrollWidth")
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        return scroll_width
