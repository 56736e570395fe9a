"""The report in a browser: what a reader sees, clicks, types and takes away.

    report.py INDEX REPORT ABSENT [PICTURES]

INDEX is `index.html` of a folder of results, REPORT the page of `kesf report`; both hold the shipped fabrics and one
whose name is markup. ABSENT is a text that neither may hold: the folder that the inputs were read from. With a folder
PICTURES, what was seen is put there.

Every check is counted; the last line is `N passed, N failed`.
"""

import csv
import io
import json
import re
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

try:
    from axe_playwright_python.sync_playwright import Axe
except ImportError:
    Axe = None

DESKTOP, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 844}
passed, failed = 0, 0


def check(what, holds, found=None):
    global passed, failed
    if holds:
        passed += 1
    else:
        failed += 1
        print(f"FAILED: {what}" + ("" if found is None else f": found {found!r}"))


def opened(browser, path, viewport=DESKTOP, scheme="light", fragment="", **options):
    """A page with what it asked for and what it complained of."""
    context = browser.new_context(viewport=viewport, color_scheme=scheme, accept_downloads=True, **options)
    page = context.new_page()
    page.requests, page.complaints = [], []
    page.on("request", lambda request: page.requests.append(request.url))
    page.on("console", lambda message: page.complaints.append(message.text))
    page.on("pageerror", lambda error: page.complaints.append(str(error)))
    page.goto(path.resolve().as_uri() + fragment)
    return page


def names(page):
    return page.locator("#parameters tbody th").all_inner_texts()


def cell(page, fabric, column):
    heads = [h.split("\n")[0].strip(" ↕↑↓") for h in page.locator("#parameters thead th").all_text_contents()]
    place = next(i for i, head in enumerate(heads) if re.match(re.escape(column) + r"($|[^\w ])", head))
    row = page.locator("#parameters tbody tr", has=page.get_by_role("link", name=fabric, exact=True))
    return row.locator("th, td").nth(place)


def table(page, data):
    rows = names(page)
    check("every fabric has a row", len(rows) == len(data["fabrics"]) == 14, len(rows))
    check("every parameter has a column", page.locator("#parameters thead th").count() == len(data["columns"]) + 1)
    # 0.0864 gf·cm²/cm of B warp in tests/recorded; one gf·cm²/cm is 9.80665e-5 N·m (exact).
    column = next(i for i, c in enumerate(data["columns"]) if (c["symbol"], c["direction"]) == ("B", "warp"))
    poplin = next(f for f in data["fabrics"] if f["name"] == "poplin")["values"][str(column)]
    shown = cell(page, "poplin", "B warp" + data["columns"][column]["kes"]).inner_text()
    mean = float(shown.split(" ±")[0])
    check("the table shows KES units first", abs(mean * 9.80665e-5 / poplin["mean"] - 1) < 1e-2, shown)
    check("n stands in the cell", f"n {poplin['n']}" in shown, shown)
    doubtful = page.locator("#parameters td.doubtful").first.inner_text()
    check("a status is told in words", "doubtful" in doubtful, doubtful)
    check("there is a legend", page.locator(".legend li").count() == 4)


def sorting(page, data):
    head = page.locator("#parameters thead th", has_text="T0")
    column = next(i for i, c in enumerate(data["columns"]) if c["symbol"] == "T0")
    mean = {f["name"]: f["values"].get(str(column), {}).get("mean") for f in data["fabrics"]}

    def sorted_down(reverse):
        found = [mean[name] for name in names(page)]
        known = [v for v in found if v is not None]
        return known == sorted(known, reverse=reverse) and None not in found[: len(known)]

    head.get_by_role("button").click()
    check("a click sorts, largest first", sorted_down(True) and head.get_attribute("aria-sort") == "descending")
    head.get_by_role("button").focus()
    page.keyboard.press("Enter")
    check("a key turns the order", sorted_down(False) and head.get_attribute("aria-sort") == "ascending")
    page.locator("#parameters thead th").first.get_by_role("button").click()
    check("names sort again", names(page) == sorted(mean), names(page))


def filters(page):
    search = page.get_by_label("Search fabrics")
    search.fill("petrak_m published")
    check("search leaves what holds every word", all(n.startswith("petrak") for n in names(page)) and len(names(page)) == 6, names(page))
    search.fill("petrak_m nothing")
    check("and nothing else", names(page) == [], names(page))
    search.fill("petrak_m")
    check("the count is told", page.get_by_text("6 of 14 fabrics").count() == 1)
    search.fill("")
    page.get_by_label("Status").select_option("doubtful")
    check("the status filters", 0 < len(names(page)) < 14, names(page))
    page.get_by_label("Status").select_option("")
    page.get_by_label("Parameter to filter by").select_option(label="W")
    page.get_by_label("from, in the chosen unit").fill("20")
    heavy = names(page)
    check("a range filters in the chosen unit", {"twill", "petrak_m4"} <= set(heavy) and "poplin" not in heavy, heavy)
    page.get_by_label("from, in the chosen unit").fill("")
    page.get_by_label("shear", exact=True).uncheck()
    shown = page.locator("#parameters thead th:visible").all_inner_texts()
    check("tests are switched off", not any(h.startswith(("G", "2HG")) for h in shown), shown)
    page.get_by_label("shear", exact=True).check()


def units(page):
    before = page.locator("#parameters tbody").inner_text()
    page.get_by_role("button", name="SI", exact=True).click()
    head = page.locator("#parameters thead th", has_text="T0").inner_text()
    check("the switch changes units", head.endswith("\nm"), head)
    si = cell(page, "poplin", "T0m").inner_text()
    check("and values", "10⁻⁴" in si or si.startswith("0.00"), si)
    page.get_by_role("button", name="KES units").click()
    after = page.locator("#parameters tbody").inner_text()
    # The program wrote the first text, the script the second: both ways of rounding agree.
    check("back again every text is as it was written", before == after)


def taken_away(page, data):
    with page.expect_download() as caught:
        page.get_by_role("button", name="Download CSV").click()
    raw = Path(caught.value.path()).read_bytes()
    check("the download is UTF-8 for Excel", raw.startswith(b"\xef\xbb\xbf"))
    rows = list(csv.DictReader(io.StringIO(raw.decode("utf-8-sig"))))
    check("one line a value", len(rows) == sum(len(f["values"]) for f in data["fabrics"]), len(rows))
    poplin = next(r for r in rows if (r["fabric"], r["parameter"], r["direction"]) == ("poplin", "W", ""))
    check("values are numbers in the unit told", (poplin["mean"], poplin["unit"]) == ("11.8", "mg/cm²"), poplin)
    strange = {r["fabric"] for r in rows if "script" in r["fabric"]}
    check("what a spreadsheet takes for a formula is text", strange and all(n.startswith("'=") for n in strange), strange)
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy", exact=True).click()
    page.get_by_role("button", name="Copied").wait_for()
    copied = page.evaluate("navigator.clipboard.readText()").splitlines()
    check("copy takes a line a fabric", len(copied) == 15 and copied[0].startswith("fabric\t"), copied[:1])


def problems(page, fabrics):
    groups = page.locator("section", has_text="Problems and doubtful").locator(".findings > li")
    codes = groups.locator("p:first-child code").all_inner_texts()
    check("every code stands once", len(codes) == len(set(codes)) > 0, codes)
    cures = [g for g in groups.all_inner_texts() if "What to do:" in g]
    check("each has its cure", len(cures) == len(codes))
    text = page.locator("body").inner_text()
    beyond = [g for g in groups.all_inner_texts() if "S101" in g]
    check("linear solves beyond their meaning are told once, with the count",
          len(beyond) == 1 and f"{fabrics} of {fabrics} fabrics" in beyond[0] and text.count("S101") == 1, beyond)


def curves(page, data):
    fabric = page.locator("#fabric-poplin")
    check("a fabric opens by its link", fabric.get_attribute("open") is not None)
    charts = fabric.locator(".chart")
    index = next(i for i, f in enumerate(data["fabrics"]) if f["name"] == "poplin")
    mine = [c for c in data["curves"] if c["fabric"] == index]
    check("every test has a chart", charts.count() == len(mine) == 4, charts.count())
    thick = max(len(l["x"]) for c in mine for s in c["specimens"] for l in s["branches"])
    check("branches have at most 120 points", thick <= 120, thick)
    chart = charts.filter(has=page.locator("h4", has_text="bending"))
    drawn = lambda: chart.locator("svg path.curve").count()
    frame = chart.locator("> svg")
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    middle = (box["x"] + 0.55 * box["width"], box["y"] + 0.45 * box["height"])
    page.mouse.move(*middle)
    reading = chart.locator(".reading").inner_text()
    check("hover reads a value with its unit", re.search(r"Curvature K .* 1/cm, Moment per width M .* gf·cm/cm", reading), reading)
    axis = lambda: frame.locator("text").all_text_contents()
    whole = axis()
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.3 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.6 * box["height"])
    page.mouse.up()
    zoomed = axis()
    check("dragging zooms", zoomed != whole, zoomed)
    page.mouse.dblclick(*middle)
    check("a double click resets", axis() == whole)
    before = drawn()
    chart.get_by_label("warp, specimen 1").uncheck()
    check("a specimen is switched off", drawn() < before, drawn())
    chart.get_by_label("warp, specimen 1").check()
    check("windows of the fits are shaded", chart.locator("rect.window").count() > 0)
    check("a simulated curve lies over them", chart.locator("path.simulated").count() > 0)
    frame.focus()
    page.keyboard.press("ArrowRight")
    check("the keyboard reads", chart.locator(".reading").inner_text() != reading)


def control_chart(page, data):
    place = page.locator("#control-chart")
    text = place.inner_text()
    check("the population is named with its n", f"n = {len(data['fabrics'])}" in text, text[:300])
    check("two fabrics are compared at first", place.locator("path.line").count() >= 2)
    place.get_by_label("Fabric 3").select_option(label="twill")
    check("a third is added", place.locator(".keys span").count() == 3)
    check("the nearest are told with distance", re.search(r"Nearest to twill: .*SD over \d+ parameters", place.inner_text()))
    # The same by hand for T0, which every fabric has: z of log10 over the population.
    from math import log10
    from statistics import mean, stdev
    column = str(next(i for i, c in enumerate(data["columns"]) if c["symbol"] == "T0"))
    logs = {f["name"]: log10(f["values"][column]["mean"]) for f in data["fabrics"]}
    expected = (logs["twill"] - mean(logs.values())) / stdev(logs.values())
    place.locator("summary").click()
    row = place.locator("tr", has_text="log T0").inner_text().split()
    check("z is (x - mean) / SD of the logarithms", abs(float(row[-1].replace("−", "-")) - expected) < 0.006, (row, expected))


def policy(page, requests):
    csp = page.locator("meta[http-equiv=Content-Security-Policy]").get_attribute("content")
    check("the policy forbids everything else", csp.startswith("default-src 'none'") and "unsafe" not in csp, csp)
    foreign = [r for r in requests if not r.startswith(("file:", "data:", "blob:"))]
    check("nothing is asked of a network", not foreign, foreign)
    check("nothing is complained of", not page.complaints, page.complaints)
    page.evaluate("const s = document.createElement('script'); s.textContent = 'window.intruder = 1'; document.body.append(s)")
    check("a foreign script does not run", page.evaluate("window.intruder") is None)


def accessible(page, what):
    if Axe is None:
        return
    # axe injects itself as a script, which the policy of the page rightly forbids: the context goes around it.
    found = Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]}).response
    problems = [(v["id"], v["nodes"][0]["html"][:160], len(v["nodes"])) for v in found["violations"]]
    check(f"axe-core looked: {what}", len(found["passes"]) > 15, len(found["passes"]))
    check(f"axe-core finds nothing: {what}", not problems, problems)


def main(index, report, absent, pictures=None):
    index, report = Path(index), Path(report)
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        page = opened(browser, index, fragment="#fabric-poplin")
        data = json.loads(page.locator("#data").text_content())
        table(page, data)
        sorting(page, data)
        filters(page)
        units(page)
        taken_away(page, data)
        problems(page, len(data["fabrics"]))
        curves(page, data)
        control_chart(page, data)
        policy(page, page.requests)
        check("a name of markup is text", "=<script>alert(1)" in names(page), names(page))

        sent = opened(browser, report, fragment="#fabric-poplin")
        policy(sent, sent.requests)
        check("the page that is sent asks for nothing but itself", [r for r in sent.requests if r.startswith("file:")] == [sent.url.split("#")[0]], sent.requests)
        check("it has 3 MB at most", report.stat().st_size <= 3_000_000, report.stat().st_size)
        check("what was left out is told", sent.locator("#left-out").count() == 1)
        for path in (index, report):
            check(f"{path.name} tells no folder of this machine", absent not in path.read_text(encoding="utf-8"))

        plain = opened(browser, index, java_script_enabled=False)
        check("the table is readable without the script", len(names(plain)) == 14 and "n 3" in plain.locator("#parameters").inner_text())

        for viewport, size in ((DESKTOP, "desktop"), (PHONE, "phone")):
            for scheme in ("light", "dark"):
                seen = opened(browser, index, viewport, scheme, "#fabric-poplin", bypass_csp=True)
                wide = seen.evaluate("document.documentElement.scrollWidth - innerWidth")
                check(f"nothing but the tables scrolls sideways: {size}", wide <= 0, wide)
                accessible(seen, f"{size}, {scheme}")
                if pictures:
                    seen.screenshot(path=f"{pictures}/report_{size}_{scheme}_fabric.png")
                    seen.evaluate("scrollTo(0, 0)")
                    seen.screenshot(path=f"{pictures}/report_{size}_{scheme}.png")
        browser.close()
    if Axe is None:
        print("axe-core is not there: contrast and names were not checked")
    print(f"{passed} passed, {failed} failed")
    return failed == 0


if __name__ == "__main__":
    sys.exit(0 if main(*sys.argv[1:]) else 1)
