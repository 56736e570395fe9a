"""The report in a browser: what a reader sees, clicks, types and takes away.

    report.py INDEX REPORT ABSENT [GIVEN [LIBRARY [PICTURES]]]

INDEX is `index.html` of a folder of results, REPORT the page of `kesf report`; both hold the shipped fabrics and one
whose name is markup. ABSENT is a text that neither may hold: the folder that the inputs were read from. GIVEN is
`index.html` of a run with a population of its own and a drape, LIBRARY that of a run of 1,000 fabrics. With a folder
PICTURES, what was seen is put there, under the names that the book shows.

Every check is counted; the last line is `N passed, N failed`.
"""

import base64
import csv
import io
import json
import re
import sys
from pathlib import Path
from xml.etree import ElementTree

from openpyxl import load_workbook
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
    check("every parameter has a column", page.locator("#parameters thead th").count() == len(data["columns"]) + 2)
    # 0.0864 gf·cm²/cm of B warp in tests/recorded; one gf·cm²/cm is 9.80665e-5 N·m (exact).
    column = next(i for i, c in enumerate(data["columns"]) if (c["symbol"], c["direction"]) == ("B", "warp"))
    poplin = next(f for f in data["fabrics"] if f["name"] == "poplin")["values"][str(column)]
    shown = cell(page, "poplin", "B warp" + data["columns"][column]["kes"]).inner_text()
    mean = float(shown.split(" ±")[0])
    check("the table shows KES units first", abs(mean * 9.80665e-5 / poplin["mean"] - 1) < 1e-2, shown)
    check("n stands in the cell", f"n {poplin['n']}" in shown, shown)
    doubtful = page.locator("#parameters td.doubtful").first.inner_text()
    check("a status is told in words", "doubtful" in doubtful, doubtful)
    check("there is a legend", page.locator(".legend li").count() == 7)
    rows_of_controls = page.locator(".controls").first.locator("> *").evaluate_all("all => new Set(all.map((one) => Math.round(one.getBoundingClientRect().top / 20))).size")
    check("controls are one line", rows_of_controls <= 2 and page.locator(".controls").first.bounding_box()["height"] < 60, rows_of_controls)
    sizes = page.locator("figure img").evaluate_all("all => all.map((img) => img.getAttribute('width') && img.getAttribute('height'))")
    check("pictures have their room before they are loaded", sizes and all(sizes), sizes[:3])
    check("the origin stands beside the name", cell(page, "poplin", "origin").inner_text() == "synthetic" and
          cell(page, "petrak_m1", "origin").inner_text() == "published")
    first = list(dict.fromkeys(c["symbol"] for c in data["columns"]))[:6]
    check("what nearly every fabric has comes first", first == ["W", "T0", "B", "2HB", "G", "2HG"], first)
    check("names are broken after their words", page.locator("#parameters tbody th wbr").count() > 0)
    alts = page.locator("img").evaluate_all("all => all.map((img) => img.alt)")
    check("pictures are told in sentences", alts and all(alt.endswith(".") and ".png" not in alt for alt in alts), alts[:3])


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
    parts = page.locator("details.fabric:visible h3").all_inner_texts()
    check("sections follow", parts == names(page), parts)
    rows = page.locator("table.of-fabrics:not(.stacked) tbody tr:visible td:first-child").all_inner_texts()
    check("and predictions", rows and set(rows) == set(names(page)), rows)
    search.fill("")
    page.get_by_label("Origin").select_option("synthetic")
    check("the origin filters", names(page) == ["poplin", "satin", "twill"], names(page))
    page.get_by_label("Origin").select_option("")
    page.get_by_label("Status").select_option("doubtful")
    check("the status filters", 0 < len(names(page)) < 14, names(page))
    page.get_by_label("Status").select_option("")
    page.get_by_text("Columns and range").click()
    page.get_by_label("Parameter to filter by").select_option(label="W")
    page.get_by_label("from, in the chosen unit").fill("20")
    heavy = names(page)
    check("a range filters in the chosen unit", {"twill", "petrak_m4"} <= set(heavy) and "poplin" not in heavy, heavy)
    page.get_by_label("from, in the chosen unit").fill("")
    page.get_by_label("shear", exact=True).uncheck()
    shown = page.locator("#parameters thead th:visible").all_inner_texts()
    check("tests are switched off", not any(h.startswith(("G", "2HG")) for h in shown), shown)
    page.get_by_label("shear", exact=True).check()


def predictions(page):
    """Bending lengths, largest first, then smallest first."""
    table = page.locator("table.of-fabrics:not(.stacked)", has=page.locator("th", has_text="bending length warp")).first
    head = table.locator("th", has_text="bending length warp").first
    place = table.locator("th").evaluate_all("(all, text) => all.findIndex((th) => th.textContent === text)", head.text_content())
    found = lambda: [float(re.match(r"[\d.]+", text).group(0)) for text in table.locator(f"tbody td:nth-child({place + 1})").all_inner_texts() if text[0].isdigit()]
    head.get_by_role("button").click()
    check("predictions sort", found() == sorted(found(), reverse=True) and len(found()) > 5, found())
    head.get_by_role("button").click()
    check("both ways", found() == sorted(found()), found())
    marked = page.locator("td.marked").all_inner_texts()
    check("what speaks against a prediction stands beside it", marked and all("rests on" in text for text in marked), marked[:3])
    plates = page.locator(".caption", has_text="Linear solves, normalised").inner_text()
    check("what a linear solve cannot say is said once, above the table", "Above it: 14 of 14 fabrics in" in plates, plates)
    captions = page.locator(".caption", has_text="laboratory measures").all_inner_texts()
    check("a run without a drape says nothing of states", captions and not any("lowest energy" in text for text in captions), captions)
    measured = page.locator("table.of-fabrics:not(.stacked) th", has_text="measured drape coefficient")
    check("but what was measured of one", measured.count() == 1, measured.count())
    heads = page.locator("table.of-fabrics:not(.stacked) th").all_inner_texts()
    check("cases stand under their titles", not any("cantilever_strip" in head for head in heads), heads)
    links = page.locator("table.of-fabrics tbody td:first-child a").evaluate_all("all => all.map((a) => a.getAttribute('href'))")
    check("names lead to their fabrics", len(links) > 14 and all(link.startswith("#fabric-") for link in links), links[:3])


def sections(page):
    """A section begins with what is known of the fabric."""
    part = page.locator("#fabric-petrak_m1")
    facts = part.locator(".facts").first.text_content()
    check("source and notes of fabric.toml are told", "CC-BY-4.0" in facts and "read second-hand" in facts, facts)
    matrices = part.locator("details.more", has_text="Shell section")
    for details in (part, matrices):
        details.evaluate("details => { details.open = true; }")
    text = matrices.inner_text()
    check("the section is there with what it rests on", all(name in text for name in ("D_m, x", "D_b, xy", "D_s, yz", "assumed: ", "gf/cm")), text[:400])
    page.get_by_role("button", name="SI", exact=True).click()
    check("and follows the switch of units", "N·m" in matrices.inner_text() and "gf/cm" not in matrices.inner_text(), matrices.inner_text()[:400])
    page.get_by_role("button", name="KES units").click()
    listed = part.locator("table").first.locator("tbody tr").count()
    check("and its parameters are listed", listed > 5, listed)


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
    book = taken_workbook(page)
    sheet = book["fabrics"]
    heads = [c.value for c in sheet[1]]
    check("a workbook has a line a fabric", [c.value for c in sheet["A"]][1:] == [f["name"] for f in data["fabrics"]])
    line = next(row for row in sheet.iter_rows(min_row=2, values_only=True) if row[0] == "poplin")
    check("and its numbers in the unit of the page", line[heads.index("W (mg/cm²)")] == 11.8, heads)
    check("its statistics have a line a value", book["statistics"].max_row == len(rows) + 1, book["statistics"].max_row)
    page.get_by_role("button", name="SI", exact=True).click()
    heads = [c.value for c in taken_workbook(page)["fabrics"][1]]
    check("the switch of units holds for it", "W (kg/m²)" in heads, heads)
    page.get_by_role("button", name="KES units").click()
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy", exact=True).click()
    page.get_by_role("button", name="Copied").wait_for()
    copied = page.evaluate("navigator.clipboard.readText()").splitlines()
    check("copy takes a line a fabric", len(copied) == 15 and copied[0].startswith("fabric\torigin\t"), copied[:1])
    heads = copied[0].split("\t")
    told = {h.removesuffix(" status") for h in heads if h.endswith(" status")}
    expected = {f"{c['symbol']} {c['direction'] or ''}".strip() for i, c in enumerate(data["columns"])
                if any(f["values"].get(str(i), {}).get("status", "measured") != "measured" for f in data["fabrics"])}
    check("and the status of what is not all measured", expected and told == expected, (told, expected))


def taken_workbook(page):
    with page.expect_download() as caught:
        page.get_by_role("button", name="Download XLSX").click()
    check("it is called a workbook", caught.value.suggested_filename.endswith(".xlsx"), caught.value.suggested_filename)
    return load_workbook(io.BytesIO(Path(caught.value.path()).read_bytes()))


def problems(page, fabrics):
    groups = page.locator("section", has_text="Problems and doubtful").locator(".findings > li")
    codes = groups.locator("p:first-child code").all_inner_texts()
    check("every code stands once", len(codes) == len(set(codes)) > 0, codes)
    cures = [g for g in groups.all_inner_texts() if "What to do:" in g]
    check("each has its cure", len(cures) == len(codes))
    check("values that cannot be come first", codes[0] == "K011", codes)
    doubtful = page.locator("table.stacked tbody tr")
    links = doubtful.locator("a").evaluate_all("all => all.map((a) => a.getAttribute('href'))")
    check("every doubtful value leads to its cause", len(links) >= doubtful.count() > 0 and
          all(page.locator(f"[id='{link[1:]}']").count() == 1 for link in links), links)
    text = page.locator("body").inner_text()
    beyond = [g for g in groups.all_inner_texts() if "S101" in g]
    check("linear solves beyond their meaning are told once, with the count",
          len(beyond) == 1 and f"{fabrics} of {fabrics} fabrics" in beyond[0] and text.count("S101") == 1, beyond)


def curves(page, data):
    fabric = page.locator("#fabric-poplin")
    check("a fabric opens by its link", fabric.get_attribute("open") is not None)
    charts = fabric.locator(".charts .chart")
    index = next(i for i, f in enumerate(data["fabrics"]) if f["name"] == "poplin")
    mine = [c for c in data["curves"] if c["fabric"] == index]
    check("every test has a chart", charts.count() == len(mine) == 4, charts.count())
    thick = max(len(l["x"]) for c in mine for s in c["specimens"] for l in s["branches"])
    check("branches have at most 120 points", thick <= 120, thick)
    chart = charts.filter(has=page.locator("h4", has_text="bending"))
    drawn = lambda: chart.locator("svg path.curve").count()
    frame = chart.locator("> svg")
    frame.scroll_into_view_if_needed()
    told = frame.get_attribute("aria-label")
    check("a chart is told in numbers", re.search(
        r"bending of poplin, warp and weft: Moment .* against Curvature .* 6 synthetic specimens, .* simulated curves?; B warp [\d.]+ gf", told), told)
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
    dashed = lambda kind: chart.locator(f"svg path.curve{kind}").evaluate_all("all => all.map((p) => getComputedStyle(p).strokeDasharray)")
    check("dashes are simulated, and nothing measured has them",
          "none" not in dashed(".simulated") and set(dashed(":not(.simulated)")) == {"none"}, dashed(""))
    with page.expect_download() as caught:
        chart.get_by_role("button", name="Save SVG").click()
    drawing = ElementTree.parse(caught.value.path()).getroot()
    paths = [p for p in drawing.iter("{http://www.w3.org/2000/svg}path") if "curve" in p.get("class", "")]
    check("a chart is saved as SVG with its styles", caught.value.suggested_filename == "poplin_bending.svg" and
          len(paths) == frame.locator("path.curve").count() and all(p.get("stroke", "").startswith("rgb") and p.get("fill") == "none" for p in paths),
          (caught.value.suggested_filename, len(paths)))
    chart.get_by_role("button", name="Zoom in").click()
    check("a button zooms", axis() != whole)
    chart.get_by_role("button", name="Reset the zoom").click()
    check("and one resets", axis() == whole)
    frame.focus()
    page.keyboard.press("ArrowRight")
    check("the keyboard reads", chart.locator(".reading").inner_text() != reading)


def logarithmic(page):
    """The pressure of compression on a logarithmic axis: decades are as far apart as others."""
    chart = page.locator("#fabric-poplin .charts .chart", has=page.locator("h4", has_text="compression"))
    svg = chart.locator("> svg")
    linear = svg.locator("text").all_text_contents()
    check("only compression has a logarithmic axis", page.locator("#fabric-poplin").get_by_label("logarithmic pressure").count() == 1)
    chart.get_by_label("logarithmic pressure").check()
    places = svg.evaluate(
        "s => [...s.querySelectorAll('text[text-anchor=end]')].map((t) => [Number(t.textContent), Number(t.getAttribute('y'))])")
    at = dict(map(tuple, places))
    check("the axis changes", svg.locator("text").all_text_contents() != linear and {0.1, 1, 10} <= set(at), places)
    check("decades are equal", abs((at[0.1] - at[1]) - (at[1] - at[10])) < 1, places)
    chart.get_by_label("logarithmic pressure").uncheck()
    check("and back", svg.locator("text").all_text_contents() == linear)


def control_chart(page, data):
    place = page.locator("#control-chart")
    text = place.inner_text()
    check("the population is named with its n", f"n = {len(data['fabrics'])}" in text, text[:300])
    check("two fabrics are compared at first", place.locator("path.line").count() >= 2)
    place.get_by_label("Fabric 3").select_option(label="twill (synthetic)")
    check("a third is added", place.locator(".keys span").count() == 3)
    check("the nearest are told with distance", re.search(r"Nearest to twill \(synthetic\): .*SD over \d+ parameters", place.inner_text()))
    # The same by hand for T0, which every fabric has: z of log10 over the population.
    from math import log10
    from statistics import mean, stdev
    column = str(next(i for i, c in enumerate(data["columns"]) if c["symbol"] == "T0"))
    logs = {f["name"]: log10(f["values"][column]["mean"]) for f in data["fabrics"]}
    expected = (logs["twill"] - mean(logs.values())) / stdev(logs.values())
    place.locator("summary").click()
    row = place.locator("tr", has_text="log T0").inner_text().split()
    check("z is (x - mean) / SD of the logarithms", abs(float(row[-1].replace("−", "-")) - expected) < 0.006, (row, expected))
    # A fabric with values that are not measured: as many points are hollow, and say why.
    from collections import Counter
    marks = lambda f: Counter(v["status"] for i, v in f["values"].items() if data["columns"][int(i)]["log"] is not None and v["status"] != "measured")
    fabric = max(data["fabrics"], key=lambda f: sum(marks(f).values()))
    check("a fabric has values that are not measured", marks(fabric), marks(fabric))
    place.get_by_label("Fabric 4").select_option(label=f"{fabric['name']} ({fabric['origin']})")
    titles = place.locator("svg[role=img] circle.hollow title").all_text_contents()
    check("they are hollow and told", titles and all(re.search(r", (inferred|assumed|doubtful)$", t) for t in titles) and any(t.startswith(fabric["name"]) for t in titles), titles)
    check("with their key", "hollow: inferred, assumed or doubtful" in place.locator(".keys").inner_text())
    check("and marked in the table", place.locator("td.inferred, td.assumed, td.doubtful").count() == len(titles), len(titles))
    check("solid points have no mark", not [t for t in place.locator("svg[role=img] circle:not(.hollow) title").all_text_contents() if not t.endswith(" SD")])
    check("the origins of the population are told", f"{sum(f['origin'] == 'synthetic' for f in data['fabrics'])} synthetic" in text, text[:300])


def turning(page, data):
    viewer = page.locator("#fabric-poplin .viewer")
    index = next(i for i, f in enumerate(data["fabrics"]) if f["name"] == "poplin")
    mine = [s for s in data["shapes"]["sheets"] if s["fabric"] == index]
    canvas = viewer.locator("canvas").first
    canvas.scroll_into_view_if_needed()
    check("no sheet is left out without a word", data["shapes"]["left_out"] == [] or "do not turn in this page" in page.locator(".lead").inner_text())
    chosen, colour = viewer.locator("select").first, viewer.get_by_label("Colour")
    check("every sheet of the fabric can be chosen", chosen.locator("option").count() == len(mine) >= 2, len(mine))
    picture = canvas.screenshot
    ink = canvas.evaluate(
        "c => { const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;"
        " for (let i = 3; i < d.length; i += 4) if (d[i] > 128) n++; return n / (c.width * c.height); }")
    check("a sheet is seen", 0.02 < ink < 0.9, ink)
    first = picture()
    page.wait_for_timeout(300)
    check("nothing moves by itself", picture() == first)
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 150)
    page.mouse.down()
    page.mouse.move(box["x"] + 320, box["y"] + 190, steps=4)
    page.mouse.up()
    page.wait_for_timeout(100)
    turned = picture()
    check("the mouse turns it", turned != first)
    canvas.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(100)
    check("a key turns it", picture() != turned)
    page.keyboard.press("0")
    page.wait_for_timeout(100)
    check("and 0 resets", picture() == first)
    viewer.get_by_label("outline before").uncheck()
    check("the outline before can be left out", picture() != first)
    viewer.get_by_label("outline before").check()
    check("deflection, curvature and moment can be seen", colour.locator("option").all_inner_texts() == [
        "length of the displacement", "largest principal curvature", "largest principal moment"])
    seen = [picture()]
    for i, (unit, field) in enumerate(zip(("1/m", "N"), mine[0]["fields"])):
        colour.select_option(index=i + 1)
        told = viewer.locator(".reading").inner_text()
        check("what the colours are is told with its largest value", field["name"] in told and unit in told and field["unit"] == unit, told)
        seen.append(picture())
    # Where one rigidity counts, moments are curvatures times it, and look the same.
    check("the colours differ", seen[0] not in seen[1:])
    colour.select_option(index=0)
    for i, sheet in enumerate(mine):
        chosen.select_option(index=i)
        told = viewer.locator(".reading").inner_text()
        expected = "shown as it is" if sheet["scale"] == 1 else "times as large"
        check("the scale factor is told", expected in told, (told, sheet["scale"]))
    check("the file is named", viewer.locator("a").get_attribute("href") == "./" + mine[-1]["file"], mine[-1]["file"])


def draped(page, data):
    """The shipped drape has more than 5000 nodes, and turns."""
    index = next(i for i, f in enumerate(data["fabrics"]) if f["name"] == "poplin")
    mine = [s for s in data["shapes"]["sheets"] if s["fabric"] == index]
    nodes = len(base64.b64decode(mine[0]["values"]))
    check("a drape is in the page, with all of its nodes", mine[0]["is_drape"] and nodes > 5000, (mine[0]["title"], nodes))
    page.locator("#fabric-poplin").evaluate("details => { details.open = true; }")
    canvas = page.locator("#fabric-poplin .viewer canvas").first
    canvas.scroll_into_view_if_needed()
    said = page.locator("table.of-fabrics", has=page.locator("th", has_text="drape coefficient")).first.inner_text()
    check("a drape is one cell", re.search(r"\d+\.\d \(\d+\.\d–\d+\.\d\), \d+ folds", said), said[:300])
    check("and can be chosen", "drape" in page.locator("#fabric-poplin .viewer option").first.inner_text())
    first = canvas.screenshot()
    canvas.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(200)
    check("and turns", canvas.screenshot() != first)


def correlation(page, data):
    place = page.locator("#correlation")
    from math import log10
    from statistics import correlation as pearson
    place.scroll_into_view_if_needed()
    column = lambda symbol, direction=None: str(next(
        i for i, c in enumerate(data["columns"]) if (c["symbol"], c["direction"]) == (symbol, direction)))

    def known(fabric):
        mean = lambda *key: fabric["values"].get(column(*key), {}).get("mean")
        both = [mean("B", "warp"), mean("B", "weft")]
        b = mean("B") if None in both else sum(both) / 2
        return None if None in (b, mean("W")) else (log10(b), log10(mean("W")))

    pairs = [p for p in map(known, data["fabrics"]) if p]
    expected = pearson(*zip(*pairs))
    button = place.get_by_role("button", name=re.compile(r"^log B and log W: "))
    label = button.get_attribute("aria-label")
    found = float(re.search(r"r ([−\d.]+),", label).group(1).replace("−", "-"))
    check("a coefficient is Pearson's of the logarithms", abs(found - expected) < 0.006, (label, expected))
    check("with its n", label.endswith(f"n {len(pairs)}"), label)
    few = place.locator("td.few").all_inner_texts()
    check("below n = 5 there is no number", all(re.fullmatch(r"n [0-4]", text.strip()) for text in few), few)
    button.click()
    check("the points behind it are shown", place.locator(".chart svg[role=img] circle").count() == len(pairs), place.locator(".chart svg[role=img] circle").count())
    check("and told", re.search(r"log B against log W: r = .* to .*n = " + str(len(pairs)), place.locator(".reading").inner_text()) or
          re.search(r"log W against log B", place.locator(".reading").inner_text()), place.locator(".reading").inner_text())
    with page.expect_download() as caught:
        place.get_by_role("button", name=re.compile("^Save SVG of ")).click()
    svg = Path(caught.value.path()).read_text()
    check("and saved as SVG", svg.count("<circle") == len(pairs) and "log B" in svg, svg[:200])


def touched(browser, index):
    """On a phone: a finger reads, buttons zoom, text is as large as elsewhere."""
    page = opened(browser, index, PHONE, fragment="#fabric-poplin", has_touch=True, is_mobile=True)
    chart = page.locator("#fabric-poplin .charts .chart", has=page.locator("h4", has_text="bending"))
    frame = chart.locator("> svg")
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    page.touchscreen.tap(box["x"] + 0.6 * box["width"], box["y"] + 0.4 * box["height"])
    reading = chart.locator(".reading").inner_text()
    check("a tap reads a value", re.search(r"Curvature K .* 1/cm, Moment", reading), reading)
    axis = lambda: frame.locator("text").all_text_contents()
    whole = axis()
    chart.get_by_role("button", name="Zoom in").tap()
    check("a finger zooms by a button", axis() != whole)
    chart.get_by_role("button", name="Reset the zoom").tap()
    check("and resets", axis() == whole)
    for what in (frame, page.locator("#control-chart svg[role=img]"), page.locator("#correlation svg[role=img]")):
        height = what.locator("text").first.evaluate("text => text.getBoundingClientRect().height")
        check("text of charts is read on a phone", height >= 11, height)
    beyond = page.locator("table.stacked td").evaluate_all("all => all.filter((td) => td.getBoundingClientRect().right > innerWidth).length")
    check("nothing of a doubtful value is cut off", beyond == 0, beyond)
    page.context.close()


def on_paper(browser, index):
    """As it is printed on A4 with narrow margins: everything open, nothing cut off, light; and afterwards as before."""
    page = opened(browser, index, {"width": 720, "height": 1040}, "dark")
    closed = page.locator("details:not([open])").count()
    page.emulate_media(media="print", color_scheme="dark")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    check("everything is open on paper", page.locator("details:not([open])").count() == 0 < closed, closed)
    fabrics = page.locator(".paper thead th").all_inner_texts()
    check("every fabric is on paper", len([f for f in fabrics if f != "parameter"]) == 14, fabrics)
    wide = page.locator(".paper table, .stacked").evaluate_all("all => Math.max(...all.map((table) => table.getBoundingClientRect().right)) - innerWidth")
    check("and no table of them is cut off", wide <= 0, wide)
    check("the table for the screen is not", not page.locator("#parameters").is_visible())
    check("curves are drawn", page.locator("#fabric-twill .charts svg path.curve").count() > 0)
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    check("paper is white", ground == "rgb(255, 255, 255)", ground)
    check("headings do not stick", page.locator("thead th").evaluate_all("all => all.every((th) => getComputedStyle(th).position === 'static')"))
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    check("afterwards it is as before", page.locator("details:not([open])").count() == closed and page.locator(".paper").count() == 0)
    page.emulate_media(media="screen")
    check("and a page can be made of it", page.pdf().startswith(b"%PDF"))
    page.context.close()


def left_out(sent):
    """In a page to be sent what is worth most comes first, and what is not there is told once a fabric."""
    kinds = sent.locator("figure img").evaluate_all("all => all.map((img) => img.dataset.kind)")
    check("cantilevers come before plates", kinds.count("cantilever") > 0 and "plate" not in kinds, kinds)
    lines = sent.locator("details.fabric").evaluate_all("all => all.map((one) => one.querySelectorAll('.figures .absent').length)")
    check("one line a fabric tells what is not", max(lines) <= 1, lines)
    names = sent.locator(".figures .absent").all_text_contents()
    told = re.search(r": (\d+) pictures", sent.locator("#left-out").inner_text())
    check("every picture that is left out is counted", told and int(told.group(1)) == sum(name.count(".png") for name in names), (told, names))


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


def photographed(page, pictures, size):
    """The pictures of the book."""
    if size == "desktop":
        for part, name in ((".viewer", "sheets"), (".charts", "curves")):
            place = page.locator(f"#fabric-poplin {part}").first
            place.scroll_into_view_if_needed()
            page.wait_for_timeout(300)
            place.screenshot(path=f"{pictures}/report_{name}.png")
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=f"{pictures}/report{'' if size == 'desktop' else '_' + size}.png")


def many(browser, index):
    """The index and a page of a run of 1,000 fabrics: it opens, sorts, and leads to its fabrics."""
    page = opened(browser, index)
    page.locator("table.of-fabrics tbody tr").first.wait_for()
    paint = page.evaluate("performance.getEntriesByType('paint').find((e) => e.name === 'first-contentful-paint')?.startTime")
    print(f"1,000 fabrics: first contentful paint of the index after {paint:.0f} ms")
    check("the index of 1,000 fabrics is painted within a second", paint < 1000, paint)
    table = page.locator("table.of-fabrics", has=page.locator("th", has_text="B warp"))
    check("it has a line a fabric", table.locator("tbody tr").count() == 1000, table.locator("tbody tr").count())
    links = page.locator(".files a", has_text="… to ").all_inner_texts()
    check("links say what is on a page", len(links) == 5, links)
    first = lambda: table.locator("tbody tr td:first-child").first.inner_text()
    start, head = first(), table.locator("th", has_text="fabric").get_by_role("button")
    head.click()
    before = page.evaluate("performance.now()")
    head.click()
    check("it sorts at once", first() != start and page.evaluate("performance.now()") - before < 2000, (start, first()))
    table.locator("tbody a").first.click()
    page.locator("#parameters tbody tr").first.wait_for()
    # The part of the fabric opens after the rows of the tables stand.
    page.locator("details.fabric[open] h3").first.wait_for()
    opened_part = page.locator("details.fabric[open] h3").all_inner_texts()
    check("a name leads to the fabric on its page", len(opened_part) == 1 and len(names(page)) == 100, opened_part)
    paint = page.evaluate("performance.getEntriesByType('paint').find((e) => e.name === 'first-contentful-paint')?.startTime")
    print(f"1,000 fabrics: first contentful paint of a page of 200 after {paint:.0f} ms")
    check("nothing is complained of", not page.complaints, page.complaints)
    page.context.close()


def main(index, report, absent, given=None, library=None, pictures=None):
    index, report = Path(index), Path(report)
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        page = opened(browser, index, fragment="#fabric-poplin")
        data = json.loads(page.locator("#data").text_content())
        table(page, data)
        sorting(page, data)
        filters(page)
        predictions(page)
        sections(page)
        units(page)
        taken_away(page, data)
        problems(page, len(data["fabrics"]))
        curves(page, data)
        logarithmic(page)
        control_chart(page, data)
        correlation(page, data)
        turning(page, data)
        policy(page, page.requests)
        # A folder cannot have the name everywhere: the fabric is called otherwise, and the name stands in what is told of it.
        told = page.locator(".findings", has_text="O056").first.inner_text()
        check("a name of markup is text", "=-script-alert(1)" in names(page) and "=<script>alert(1)" in told, told[:300])

        sent = opened(browser, report, fragment="#fabric-poplin")
        policy(sent, sent.requests)
        check("the page that is sent asks for nothing but itself", [r for r in sent.requests if r.startswith("file:")] == [sent.url.split("#")[0]], sent.requests)
        check("it has 3 MB at most", report.stat().st_size <= 3_000_000, report.stat().st_size)
        check("what was left out is told", sent.locator("#left-out").count() == 1)
        left_out(sent)
        touched(browser, index)
        on_paper(browser, index)
        for path in (index, report):
            check(f"{path.name} tells no folder of this machine", absent not in path.read_text(encoding="utf-8"))

        if given:
            own = opened(browser, Path(given))
            place = own.locator("#control-chart")
            own_data = json.loads(own.locator("#data").text_content())
            source = own_data["population"]["source"]
            check("a population that was given is named", f"given with the run: {source}" in place.inner_text(), place.inner_text()[:400])
            check("and at the axis of the chart", source in place.locator("svg text").last.text_content())
            column = str(next(i for i, c in enumerate(own_data["columns"]) if c["symbol"] == "W"))
            place.get_by_label("Fabric 1").select_option(label="poplin (synthetic)")
            weight = next(f for f in own_data["fabrics"] if f["name"] == "poplin")["values"][column]["mean"]
            from math import log10
            # kg/m² in mg/cm²: 100 times as many; mean and SD are those of the file.
            expected = (log10(100 * weight) - 1.2) / 0.15
            place.locator("summary").click()
            row = place.locator("tr", has_text="log W").inner_text().split()
            draped(own, own_data)
            check("z is of its mean and SD", abs(float(row[-2].replace("−", "-")) - expected) < 0.006, (row, expected))

        if library:
            many(browser, Path(library))

        plain = opened(browser, index, java_script_enabled=False)
        check("the table is readable without the script", len(names(plain)) == 14 and "n 3" in plain.locator("#parameters").inner_text())

        for viewport, size in ((DESKTOP, "desktop"), (PHONE, "phone")):
            for scheme in ("light", "dark"):
                seen = opened(browser, index, viewport, scheme, "#fabric-poplin", bypass_csp=True)
                wide = seen.evaluate("document.documentElement.scrollWidth - innerWidth")
                check(f"nothing but the tables scrolls sideways: {size}", wide <= 0, wide)
                accessible(seen, f"{size}, {scheme}")
                if pictures and scheme == "light":
                    photographed(seen, pictures, size)
        browser.close()
    if Axe is None:
        print("axe-core is not there: contrast and names were not checked")
    print(f"{passed} passed, {failed} failed")
    return failed == 0


if __name__ == "__main__":
    sys.exit(0 if main(*sys.argv[1:]) else 1)
