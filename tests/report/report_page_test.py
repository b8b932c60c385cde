#!/usr/bin/env python3
"""The HTML report in a real browser: a small run is made, its report is opened from the disk and used as a reader would.

usage: report_page_test.py PROBEBENCH SCREENSHOT_FOLDER [unittest's arguments]
Exits with 77 (skipped) where Chromium, its driver or Selenium is missing; scripts/packages.txt has them all.
"""
import base64
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    from page_driver import CHROMIUM, DRIVER, Page, start_browser
    MISSING = [file for file in (CHROMIUM, DRIVER) if not os.path.exists(file)]
except ModuleNotFoundError as absent:
    MISSING = [absent.name]

SUITE = """
schema = 1
name = "page"
image = { size = [160, 90], samples = 4 }
images = { frames = "%s" }
reference = { depth = "converged", spp = 4 }
cost = { repetitions = 2 }
[[scene]]
use = "builtin:mirrors?count=2"
frames = 0
[[scene]]
use = "builtin:teapot"
frames = [2, 4]
[grid]
resolution = [8, 32]
refresh = ["every-frame", "static"]
bounces = [1, 2]
"""
WIDTH, HEIGHT = 160, 90
EVIL = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 1'>"


def significant(value, digits=3):
    """As the tables print numbers."""
    if value is None or math.isnan(value):
        return "–"
    if value == 0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if exponent < -4 or exponent >= 6:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - exponent)}f}"


def metric(cell, key, region="mask_metrics"):
    value = cell[region][key]
    return value["mean"] if isinstance(value, dict) else value


def technique(cell):
    return {axis: cell["technique"][axis] for axis in ("resolution", "refresh", "bounces")}


def key_of(cell):
    axes = " ".join(f"{axis}={value}" for axis, value in technique(cell).items())
    return f"scene={cell['scene']} camera={cell['camera']} frame={cell['frame']} {axes}"


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="report-page-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        (cls.folder / "suite.toml").write_text(SUITE % "last")
        cls.probebench("run", cls.folder / "suite.toml", "--out", cls.folder / "run", "--store", cls.folder / "store")
        cls.results = json.loads((cls.folder / "run/results.json").read_text())
        cls.report = cls.make_report("report", cls.folder / "run")
        cls.browser = start_browser()
        cls.addClassCleanup(cls.browser.quit)

    @classmethod
    def probebench(cls, *arguments):
        return subprocess.run([PROBEBENCH, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    @classmethod
    def make_report(cls, name, *arguments):
        cls.probebench("report", *arguments, "-o", cls.folder / name)
        return cls.folder / name / "report.html"

    def open(self, place="", report=None):
        page = Page(self.browser, report or self.report, place)
        self.addCleanup(lambda: self.assertEqual(page.errors(), []))
        return page

    def cells(self, scene):
        return [cell for cell in self.results["cells"] if cell["scene"].startswith(scene)]

    def choose_scene(self, page, text):
        options = page.script("return [...document.querySelectorAll('.controls.sticky select')[0].options].map((o) => [o.text, o.value])")
        page.enter(".controls.sticky select", next(value for title, value in options if text in title))

    # --- Numbers

    def test_techniques_show_the_numbers_of_results_json(self):
        page = self.open()
        rows = {(row["resolution"], row["refresh"], row["bounces"]): row for row in page.table("#techniques")}
        cells = self.cells("builtin:mirrors")
        self.assertEqual(len(rows), len(cells))
        for cell in cells:
            row = rows[tuple(technique(cell).values())]
            for name in ("flip_hdr", "relmse", "ssim"):
                self.assertEqual(row[name], significant(metric(cell, name)))
            self.assertEqual(row["frame_ms"], significant(cell["cost"]["frame_ms"]))
            self.assertEqual(row["ratio"], significant(cell["cost"]["ratio"]))

    def test_techniques_of_several_frames_show_their_mean_and_worst(self):
        page = self.open()
        self.choose_scene(page, "teapot")
        cells = self.cells("builtin:teapot")
        for row in page.table("#techniques"):
            errors = [metric(c, "flip_hdr") for c in cells if tuple(technique(c).values()) == (row["resolution"], row["refresh"], row["bounces"])]
            self.assertEqual(len(errors), 2)
            self.assertEqual(row["flip_hdr"], significant(sum(errors) / 2))
            self.assertEqual(row["p95"], significant(max(errors)))  # the worst of fewer than 20 frames
            self.assertEqual(row["worst"], significant(max(errors)))

    def test_a_cell_shows_the_numbers_of_results_json(self):
        cell = self.cells("builtin:teapot")[-1]
        page = self.open("#cell=" + key_of(cell).replace(" ", "+"))
        for row, name in zip(page.table("#cell .numbers"), ("flip_hdr", "flip_ldr", "relmse", "mse", "mae", "smape", "ssim", "psnr")):
            self.assertEqual(row["mask"], significant(metric(cell, name)), name)
            self.assertEqual(row["whole"], significant(metric(cell, name, "metrics")), name)
        shown = page.script("return [...document.querySelectorAll('#cell caption')].find((c) => c.textContent === 'Errors by object').parentElement.tBodies[0].textContent")
        for entry in cell["objects"]:
            self.assertIn(entry["object"], shown)
            self.assertIn(significant(entry["flip_hdr"]), shown)

    def test_pictures_are_those_of_the_renderer(self):
        cell = self.cells("builtin:mirrors")[0]
        settings = [part for axis, value in technique(cell).items() for part in ("--set", f"{axis}={value}")]
        png = self.folder / "rendered.png"
        self.probebench("render", cell["scene"], "--with", "raster", "--size", f"{WIDTH}x{HEIGHT}", "--samples", "4", "-o", png, *settings)
        page = self.open("#cell=" + key_of(cell).replace(" ", "+"))
        codes = page.browser.execute_async_script("""
          const done = arguments[1], bytes = Uint8Array.from(arguments[0]);
          createImageBitmap(new Blob([bytes], {type: "image/png"})).then((bitmap) => {
            const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
            context.drawImage(bitmap, 0, 0);
            done([...context.getImageData(0, 0, bitmap.width, bitmap.height).data]);
          });""", list(png.read_bytes()))
        for x, y in ((0, 0), (159, 89), (40, 45), (80, 45), (97, 52), (120, 60)):
            text = page.pixel(x, y, WIDTH, HEIGHT)
            self.assertTrue(text.startswith(f"pixel {x}, {y}"), text)
            values = [float(v) for v in text.split("rendered ")[1].split()[:3]]
            encoded = [255 * (12.92 * v if v <= 0.0031308 else 1.055 * min(v, 1) ** (1 / 2.4) - 0.055) for v in values]
            at = 4 * (y * WIDTH + x)
            # Three digits of a value are within 0.5 %, which is below 0.6 codes of 255 after the curve; then both round.
            for channel in range(3):
                self.assertAlmostEqual(encoded[channel], codes[at + channel], delta=1.2, msg=f"{x} {y}")

    # --- Tables

    def test_a_click_on_a_head_sorts_and_a_second_one_turns_round(self):
        page = self.open()
        for sign in (1, -1):
            page.click("#techniques th[data-key=flip_hdr] button")
            values = [sign * float(row["flip_hdr"]) for row in page.table("#techniques")]
            self.assertEqual(values, sorted(values))
            state = page.one("#techniques th[data-key=flip_hdr]").get_attribute("aria-sort")
            self.assertEqual(state, "ascending" if sign > 0 else "descending")

    def test_filters_take_words_and_comparisons(self):
        page = self.open()
        errors = sorted(metric(cell, "flip_hdr") for cell in self.cells("builtin:mirrors"))
        limit = (errors[3] + errors[4]) / 2
        for text, count in (("static", 4), ("refresh=static bounces=2", 2), ("resolution<=8", 4), ("bounces!=1", 4),
                            (f"flip_hdr<{limit}", sum(e < limit for e in errors)), ("nothing like it", 0)):
            page.enter("#techniques input[type=search]", text)
            rows = [row for row in page.table("#techniques") if "resolution" in row]
            self.assertEqual(len(rows), count, text)
        self.assertIn("No row passes", page.text("#techniques tbody"))

    # --- Viewer

    def viewer(self, cell=None):
        cell = cell or self.cells("builtin:mirrors")[0]
        page = self.open("#cell=" + key_of(cell).replace(" ", "+"))
        self.assertEqual(page.open_cell(), key_of(cell))
        return page

    def test_flip_shows_the_other_picture_in_the_same_place(self):
        page = self.viewer()
        place = page.script("return JSON.stringify(document.querySelector('.stage canvas').getBoundingClientRect())")
        self.assertEqual(page.label(), "rendered")
        rendered = page.brightness()
        page.press("f")
        self.assertEqual(page.label(), "reference")
        self.assertNotEqual(page.brightness(), rendered)
        self.assertEqual(page.script("return JSON.stringify(document.querySelector('.stage canvas').getBoundingClientRect())"), place)
        page.press("f")
        self.assertEqual((page.label(), page.brightness()), ("rendered", rendered))

    def test_modes_show_what_they_say(self):
        page = self.viewer()
        stages = lambda: sum(stage.is_displayed() for stage in page.all(".stage"))
        page.press("2")
        self.assertEqual((stages(), page.label(0), page.label(1)), (2, "reference", "rendered"))
        page.press("3")
        self.assertEqual((stages(), page.label()), (1, "reference | rendered"))
        page.press("4")
        self.assertEqual(page.label(), "|rendered − reference|")
        difference = page.brightness()
        self.assertGreater(difference, 0)
        page.press("5")
        self.assertIn("FLIP map", page.label())
        self.assertTrue(page.one(".map-legend").is_displayed())
        page.click(".modes label:nth-of-type(1)")
        self.assertEqual(page.label(), "rendered")
        self.assertGreater(page.brightness(), difference)

    def test_the_split_moves_with_its_divider(self):
        page = self.viewer()
        page.press("3")
        before = page.brightness()
        page.script("""
          const canvas = document.querySelector(".stage canvas"), box = canvas.getBoundingClientRect();
          const at = (type, x) => canvas.dispatchEvent(new PointerEvent(type, {pointerId: 1, bubbles: true, clientX: box.left + x * box.width, clientY: box.top + 20}));
          canvas.setPointerCapture = () => {};
          at("pointerdown", 0.5); at("pointermove", 0.1); at("pointerup", 0.1);""")
        self.assertEqual(page.script("return document.querySelector('.stage').style.getPropertyValue('--divider')"), "10%")
        self.assertNotEqual(page.brightness(), before)

    def test_exposure_works_on_the_radiance(self):
        page = self.viewer()
        levels = [page.brightness()]
        for _ in range(4):
            page.press("]")
            levels.append(page.brightness())
        self.assertEqual(levels, sorted(levels))
        self.assertGreater(levels[-1], levels[0] + 5)
        self.assertIn("+2.0", page.text(".toolbar .exposure + output"))
        page.press("0")
        self.assertEqual(page.brightness(), levels[0])
        page.enter(".exposure", "-8")  # 1/256: all but what shines is black
        self.assertLess(page.brightness(), levels[0] / 4)

    def test_zoom_is_the_same_on_both_sides(self):
        page = self.viewer()
        page.press("2")
        whole = [page.brightness(0), page.brightness(1)]
        page.press("+")
        self.assertNotEqual(page.brightness(0), whole[0])
        self.assertNotEqual(page.brightness(1), whole[1])
        page.click(".zoom button:nth-child(2)")
        self.assertEqual([page.brightness(0), page.brightness(1)], whole)

    def test_another_technique_may_stand_in_for_the_reference(self):
        page = self.viewer()
        options = page.script("return [...document.querySelectorAll('.toolbar select option')].map((o) => o.value)")
        self.assertEqual(len(options), 8)  # the reference and seven other techniques
        page.enter(".toolbar select", options[-1])
        page.press("f")
        page.wait(lambda: page.label() == options[-1], "the other technique is not shown")

    def test_keys_go_through_techniques_and_frames(self):
        cells = self.cells("builtin:teapot")
        last = [cell for cell in cells if cell["frame"] == 4]
        page = self.viewer(last[0])
        page.press("n")
        page.wait(lambda: page.open_cell() == key_of(last[1]), "n does not open the next technique")
        page.press(",")
        page.wait(lambda: "frame=2" in page.open_cell(), "a comma does not open the frame before")
        self.assertIn("kept no picture of this frame", page.text(".viewer .message"))
        self.assertEqual(page.label(), "reference")
        page.press(".")
        page.wait(lambda: "frame=4" in page.open_cell(), "a full stop does not open the next frame")
        self.assertEqual(page.label(), "rendered")

    def test_the_scrubber_shows_every_frame_that_was_kept(self):
        (self.folder / "all.toml").write_text(SUITE % "all")
        self.probebench("run", self.folder / "all.toml", "--out", self.folder / "all", "--store", self.folder / "store", "--only", "teapot.*resolution=8 .*bounces=1", "--no-cost")
        page = self.open(report=self.make_report("report-all", self.folder / "all"))
        page.wait(lambda: "frame=4" in page.open_cell(), "no cell is open")
        late = page.brightness()
        page.enter(".scrubber", "0")
        page.wait(lambda: "frame=2" in page.open_cell(), "the scrubber does not change the frame")
        self.assertEqual(page.label(), "rendered")
        self.assertNotEqual(page.brightness(), late)

    def test_clusters_of_error_are_cut_out_and_found_in_the_picture(self):
        cell = self.cells("builtin:mirrors")[0]
        page = self.viewer(cell)
        page.wait(lambda: len(page.all(".crops figure")) == len(cell["clusters"]), "not all clusters are shown")
        self.assertIn(cell["clusters"][0]["object"], page.text(".crops figcaption"))
        whole = page.brightness()
        page.click(".crops button")
        self.assertNotEqual(page.brightness(), whole)

    # --- Places

    def test_links_lead_to_a_cell_and_a_way_to_look_at_it(self):
        cell = self.cells("builtin:teapot")[-1]
        page = self.open("#cell=" + key_of(cell).replace(" ", "+") + "&mode=split")
        self.assertEqual(page.open_cell(), key_of(cell))
        self.assertEqual(page.label(), "reference | rendered")
        self.assertEqual(page.script("return document.querySelector('#techniques tr[aria-current]').dataset.key"), key_of(cell).split("frame=4 ")[1])
        link = page.one(".permalink").get_attribute("href")
        self.assertEqual(Page(self.browser, self.report, link[link.index("#"):]).open_cell(), key_of(cell))
        full = f"scene={cell['scene']} camera={cell['camera']} frame=4 " + " ".join(f"{a}={v}" for a, v in cell["technique"].items())
        self.assertEqual(Page(self.browser, self.report, "#cell=" + full.replace(" ", "+")).open_cell(), key_of(cell))

    def test_a_link_to_nothing_says_so(self):
        page = self.open("#cell=scene=gone")
        self.assertIn("no cell 'scene=gone'", page.text("#cell .message"))

    def test_points_of_charts_lead_to_cells(self):
        page = self.open("#cell=" + key_of(self.cells("builtin:mirrors?count=2")[0]).replace(" ", "+"))  # another than that of the point
        point = page.script("return [...document.querySelectorAll('#errors .chart:first-child .mark-symbol.role-mark path')].at(-1)")
        before = page.open_cell()
        page.script("arguments[0].scrollIntoView({block: 'center'})", point)
        page.script("const box = arguments[0].getBoundingClientRect();"
                    "for (const type of ['mousemove', 'mousedown', 'mouseup', 'click']) arguments[0].dispatchEvent(new MouseEvent(type, {bubbles: true, clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));", point)
        page.wait(lambda: page.open_cell() != before, "a click on a point opens nothing")

    def test_the_waterfall_adds_up_to_the_error(self):
        (self.folder / "attribution.toml").write_text(SUITE % "last" + "[attribution]\nresolution = 32\nspp = 2\n")
        self.probebench("run", self.folder / "attribution.toml", "--out", self.folder / "attribution", "--store", self.folder / "store",
                        "--only", "mirrors.*resolution=8 .*bounces=1", "--no-cost")
        attribution = json.loads((self.folder / "attribution/results.json").read_text())["attribution"][0]
        page = self.open(report=self.folder / "attribution/report.html")
        shown = page.script("""
          const figure = [...document.querySelectorAll("#errors figure")].find((f) => f.textContent.includes("Where the error comes from"));
          return [...figure.querySelectorAll(".mark-text.role-mark text")].map((t) => t.textContent)""")
        values = [step["mask_metrics"]["flip_hdr"] for step in attribution["steps"]]
        changes = [b - a for a, b in zip([0] + values, values)]
        signs = [("+" if c > 0 else "−" if c < 0 else "") + significant(abs(c)) for c in changes]
        self.assertEqual(shown, signs + [significant(values[-1])])

    def changed_run(self, name, change):
        shutil.copytree(self.folder / "run", self.folder / name, dirs_exist_ok=True)
        results = json.loads((self.folder / name / "results.json").read_text())
        change(results["cells"])
        (self.folder / name / "results.json").write_text(json.dumps(results))
        return self.open(report=self.make_report(f"report-{name}", self.folder / name))

    def test_without_times_the_cost_is_memory_and_no_chart_is_blank(self):
        def without_cost(cells):
            for cell in cells:
                cell["cost"] = None
        page = self.changed_run("no-cost", without_cost)
        for _ in range(2):  # what was hidden once stays hidden
            page.script("window.dispatchEvent(new Event('resize'))")
            page.wait(lambda: page.script("return [...document.querySelectorAll('figure.chart')].every((f) => f.hidden || f.querySelector('svg'))"), "a chart is blank")
        self.assertIn("probe MiB", page.text("#errors"))
        self.assertNotIn("null", page.text("#cell"))

    def cost_figure(self, page, find):
        return page.script("const figure = [...document.querySelectorAll('#errors figure')].find((f) => f.textContent.includes('Error against cost')); return " + find)

    def test_means_over_frames_have_the_intervals_of_those_that_have_one(self):
        def intervals_of_the_last_frame(cells):
            for cell in cells:
                error = cell["mask_metrics"]["flip_hdr"]["mean"]
                cell["mask_intervals"] = {"flip_hdr": [0.8 * error, 1.2 * error]} if cell["frame"] == 4 else {}
                cell["mask_floor"] = {"mse": 1e-6, "relmse": 1e-6}
        page = self.changed_run("some-intervals", intervals_of_the_last_frame)
        self.choose_scene(page, "teapot")
        bars = "[...figure.querySelectorAll('.mark-rule.role-mark line')].map((l) => Math.abs(l.getAttribute('y2') ?? 0)).filter((height) => height > 1).length"
        self.assertEqual(self.cost_figure(page, bars), 8)  # one a technique
        self.assertNotIn("not known", self.cost_figure(page, "figure.textContent"))
        self.choose_scene(page, "mirrors")  # of which no frame has any, though there is noise
        self.assertEqual(self.cost_figure(page, bars), 0)
        self.assertIn("How much of these errors is noise is not known.", self.cost_figure(page, "figure.textContent"))

    def test_cells_that_the_metrics_order_oppositely_are_shown_as_pictures(self):
        def dispute(cells):
            first, second = cells[0], cells[1]
            for cell, flip, relmse in ((first, 0.1, 0.4), (second, 0.3, 0.2)):
                cell["mask_metrics"]["flip_hdr"]["mean"], cell["mask_metrics"]["relmse"] = flip, relmse
                cell["mask_intervals"] = {}
        page = self.changed_run("disputed", dispute)
        text = page.text("#disputes")
        self.assertIn("FLIP-HDR 0.100, relMSE 0.400", text)
        page.wait(lambda: len(page.all("#disputes .dispute canvas")) % 6 == 0 and page.all("#disputes canvas"), "pictures of a dispute are missing")

    # --- The page itself

    def test_nothing_is_fetched(self):
        page = self.open()
        self.assertEqual(page.script("return performance.getEntriesByType('resource').map((e) => e.name).filter((n) => !n.startsWith('data:'))"), [])

    def test_of_equal_errors_the_cheapest_is_the_smallest(self):
        """At frame 0 every face of every policy is captured, so both policies have the same errors."""
        cells = [cell for cell in self.results["cells"] if cell["scene"].startswith("builtin:mirrors")]
        smallest = min(metric(cell, "flip_hdr") for cell in cells)
        best = min((cell for cell in cells if metric(cell, "flip_hdr") == smallest), key=lambda cell: cell["cost"]["ratio"])
        self.assertEqual(best["technique"]["refresh"], "static")
        page = self.open()
        shown = page.script("return document.querySelector('#overview tbody tr').cells[3].innerText")
        self.assertEqual(shown.split(), [f"{axis}={value}" for axis, value in technique(best).items()])

    def test_names_are_text(self):
        evil = self.folder / "evil"
        shutil.copytree(self.folder / "run", evil, dirs_exist_ok=True)
        results = json.loads((evil / "results.json").read_text())
        results["provenance"]["suite_name"] = EVIL
        for cell in results["cells"]:
            if cell["scene"].startswith("builtin:mirrors"):
                cell["scene"] = EVIL
                cell["materials"][0]["material"] = cell["objects"][0]["object"] = EVIL
        (evil / "results.json").write_text(json.dumps(results))
        page = self.open(report=self.make_report("report-evil", evil))
        self.assertIsNone(page.script("return window.hacked ?? null"))
        self.assertEqual(page.script("return document.querySelectorAll('img').length"), 0)
        for place in ("#title", "#overview", "#cell"):
            self.assertIn(EVIL, page.text(place))
        self.assertIn(EVIL, page.script("return document.title"))

    def test_every_control_has_a_name(self):
        page = self.open()
        nameless = page.script("""
          const named = (node) => node.getAttribute("aria-label") || node.labels?.length || node.textContent.trim();
          return [...document.querySelectorAll("button, input, select, canvas, [tabindex]")].filter((node) => !named(node)).map((node) => node.outerHTML)""")
        self.assertEqual(nameless, [])

    def test_large_reports_have_their_pictures_beside_them(self):
        report = self.make_report("beside", self.folder / "run", "--page-mb", "0")
        self.assertTrue(any((report.parent / "report-pictures").iterdir()))
        self.assertLess(report.stat().st_size, self.report.stat().st_size)
        page = self.open(report=report)
        self.assertEqual(page.label(), "rendered")
        self.assertGreater(page.brightness(), 0)
        self.make_report("beside", self.folder / "run")  # one that holds them itself leaves none behind
        self.assertFalse((report.parent / "report-pictures").exists())

    def test_two_runs_are_compared_cell_by_cell(self):
        later = self.folder / "later"
        shutil.copytree(self.folder / "run", later, dirs_exist_ok=True)
        results = json.loads((later / "results.json").read_text())
        changed = next(cell for cell in results["cells"] if cell["scene"].startswith("builtin:mirrors"))
        before = metric(changed, "flip_hdr")
        changed["mask_metrics"]["flip_hdr"]["mean"] = 2 * before
        changed["mask_intervals"] = {"flip_hdr": [1.9 * before, 2.1 * before]}
        results["cells"].pop()
        (later / "results.json").write_text(json.dumps(results))
        page = self.open(report=self.make_report("compared", self.folder / "run", later))
        rows = page.table("#comparison")
        self.assertEqual(len(rows), len(results["cells"]))
        self.assertTrue(rows[0]["before"].startswith(significant(before)))
        self.assertTrue(rows[0]["after"].startswith(significant(2 * before)))
        self.assertEqual(rows[0]["relative"], "100.0 %")
        self.assertEqual(rows[0]["change"], "worse")
        self.assertTrue(all(row["change"] == "equal" for row in rows[1:]))
        self.assertIn("1 cells are in the earlier run only", page.text("#comparison"))
        self.assertIn("the run before", page.text(".toolbar"))
        text = self.probebench("report", self.folder / "run", later)
        self.assertIn("before and after", text)
        self.assertLess(len(text), 6000)

    def test_it_fits_a_narrow_screen_and_prints(self):
        page = self.open()
        SCREENSHOTS.mkdir(parents=True, exist_ok=True)
        self.assertLessEqual(page.screenshot(SCREENSHOTS / "narrow.png", width=400), 400)
        for theme in ("light", "dark"):
            page.enter("#theme", theme)
            self.assertLessEqual(page.screenshot(SCREENSHOTS / f"{theme}.png"), 1280)
        background = page.script("return getComputedStyle(document.body).backgroundColor")
        self.assertEqual(background, "rgb(15, 19, 24)")
        pdf = page.browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})["data"]
        (SCREENSHOTS / "printed.pdf").write_bytes(base64.b64decode(pdf))
        page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.addCleanup(page.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"media": ""})
        self.assertEqual(page.script("return getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)")
        self.assertFalse(page.one(".toolbar").is_displayed())


if __name__ == "__main__":
    if MISSING:
        print(f"report_page_test: skipped, missing: {', '.join(MISSING)}; scripts/setup installs them")
        sys.exit(77)
    PROBEBENCH, SCREENSHOTS = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
