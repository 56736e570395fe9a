"""The page that is dropped on, in a browser: what it makes of files is what the command makes of them.

    web.py PAGE KESF WORK [PICTURES]

PAGE is what `kesf-web-build` made, KESF the command, WORK an empty folder with copies of `kesf_data` and of the cases of
the page (`page_cases`). With a folder PICTURES, what was seen is put there.

Every check is counted; the last line is `N passed, N failed`.
"""

import base64
import csv
import functools
import http.server
import io
import json
import random
import re
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path

from playwright.sync_api import sync_playwright

import report
from report import DESKTOP, PHONE, accessible, check

# Processors of the command multiply and add with one rounding, WebAssembly with two, and sine, exponential and power come from
# two libraries: last digits may differ, and a solver makes more of it. The largest difference that was seen is printed.
BOUND = 1e-6
# What the states of a drape give beside the lowest one, and how far they may differ: points of the coefficient over 100.
OF_STATES = ("drape_coefficient_mean", "drape_coefficient_least", "drape_coefficient_greatest")
OF_STATES_BOUND = 0.01
MB = 1_000_000


def opened(browser, address, viewport=DESKTOP, scheme="light", **options):
    """A page whose engine is ready, with what it asked for and what it complained of."""
    context = browser.new_context(viewport=viewport, color_scheme=scheme, accept_downloads=True, **options)
    page = context.new_page()
    page.requests, page.complaints = [], []
    page.on("request", lambda request: page.requests.append(request.url))
    page.on("console", lambda message: page.complaints.append(message.text))
    page.on("pageerror", lambda error: page.complaints.append(str(error)))
    page.goto(address)
    page.locator("body[data-ready]").wait_for(timeout=30_000)
    return page


def ended(page):
    return int(page.evaluate("document.body.dataset.ended || 0"))


def worked(page, action, seconds=600):
    """Does something that makes the page work, and waits for the end of the work; what the page says then."""
    before = ended(page)
    action()
    # What is typed waits for half a second, and may end work that goes on.
    page.wait_for_function("before => Number(document.body.dataset.ended || 0) > before", arg=before, timeout=1000 * seconds)
    page.wait_for_timeout(700)
    page.locator("body:not([data-busy])").wait_for(timeout=1000 * seconds)
    return page.locator("#status").inner_text()


def drop(page, files):
    """Drops files as a person does: one event with their data."""
    texts = [[name, base64.b64encode(data).decode()] for name, data in files]
    transfer = page.evaluate_handle(
        """(files) => {
             const transfer = new DataTransfer();
             for (const [name, text] of files) {
               transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
             }
             return transfer;
           }""",
        texts,
    )
    begin = time.perf_counter()
    page.dispatch_event("#drop", "drop", {"dataTransfer": transfer})
    return begin


def choose_folder(page, folder):
    page.locator("#folder").set_input_files(str(folder))


def cases_on(page, on):
    page.locator("#form").evaluate("form => { form.open = true; }")
    page.locator("#cases").set_checked(on)
    page.wait_for_timeout(700)


def frame(page):
    return page.frame_locator("#report")


def downloaded(page, name):
    button = page.locator(f"[data-file='{name}']")
    folder = button.locator("xpath=ancestor::details")
    if folder.count():
        folder.evaluate("details => { details.open = true; }")
    with page.expect_download() as caught:
        button.click()
    return Path(caught.value.path()).read_bytes()


def native(kesf, folder, *arguments):
    return subprocess.run([kesf, *arguments], cwd=folder, capture_output=True, text=True, check=False)


def rows(data):
    return list(csv.DictReader(io.StringIO(data.decode())))


def compared(name, of_page, of_command):
    """Every cell of a table: texts are the same, numbers within the bound. The largest relative difference."""
    ours, theirs = rows(of_page), rows(of_command)
    check(f"{name} has the rows of the command", len(ours) == len(theirs) > 0, (len(ours), len(theirs)))
    worst, moved, same, numbers, odd = 0.0, 0.0, 0, 0, []
    for mine, other in zip(ours, theirs):
        for key, text in other.items():
            try:
                expected, found = float(text), float(mine[key])
            except ValueError:
                if mine[key] != text:
                    odd.append((key, mine[key], text))
                continue
            numbers += 1
            same += mine[key] == text
            scale = max(abs(expected), 1e-300)
            difference = abs(found - expected) / scale if found != expected else 0.0
            # What is nothing but rounding has no digits to compare.
            if key in ("error", "sd") and abs(found - expected) < 1e-9:
                difference = 0.0
            # A search that starts near a ridge may come down on its other side: that is a state more or less in the band.
            is_of_states = other.get("quantity") in OF_STATES
            if is_of_states:
                moved = max(moved, abs(found - expected))
                difference = 0.0 if abs(found - expected) < OF_STATES_BOUND else difference
            if difference > BOUND:
                odd.append((key, mine[key], text, dict(other)))
            worst = max(worst, difference)
    check(f"{name} has the texts and numbers of the command", not odd, odd[:3])
    print(f"{name}: {same} of {numbers} numbers are the same to the last digit; largest relative difference {worst:.1e}; bands of drapes {moved:.4f}")


def same_digits(browser, address, kesf, work):
    page = opened(browser, address)
    status = worked(page, lambda: choose_folder(page, work / "kesf_data"))
    check("the shipped fabrics are read", status.startswith("Done: 13 fabrics, 0 errors"), status)
    native(kesf, work, "-q", "run", "kesf_data", "page_cases", "-o", "native", "--no-charts", "--xlsx")
    for name in ("fabrics.csv", "predictions.csv"):
        compared(name, downloaded(page, name), (work / "native" / name).read_bytes())
    left = [n for n in page.locator("[data-file]").evaluate_all("all => all.map((b) => b.dataset.file)")]
    on_disk = {str(p.relative_to(work / "native")) for p in (work / "native").rglob("*") if p.is_file()}
    missing = {n for n in on_disk if not n.endswith(".parquet") and not Path(n).name.startswith(".kesf")} - set(left)
    check("every file of the command is there, but for pictures and Parquet", not missing, sorted(missing)[:5])
    check("a workbook is a workbook", zipfile.is_zipfile(io.BytesIO(downloaded(page, "results.xlsx"))))
    with page.expect_download() as caught:
        page.get_by_role("button", name="Everything as one zip").click()
    names = zipfile.ZipFile(caught.value.path()).namelist()
    check("all of it is in one zip", sorted(names) == sorted(left), (len(names), len(left)))
    cards(page, kesf, work)
    shown = frame(page)
    shown.locator("#parameters tbody tr").nth(12).wait_for(timeout=10_000)
    check("the report is shown", shown.locator("#parameters tbody tr").count() == 13)
    with page.expect_download() as caught:
        shown.get_by_role("button", name="Download CSV").click()
    check("and downloads from within", Path(caught.value.path()).read_bytes().startswith(b"\xef\xbb\xbf"))
    asked = [r for r in page.requests[1:] if not r.startswith(("blob:", "data:"))]
    check("nothing was asked for", not asked, asked)
    check("nothing was complained of", not page.complaints, page.complaints)
    return page


def cards(page, kesf, work):
    worked(page, page.get_by_role("button", name="Make material cards").click)
    made = downloaded(page, "cards/u3m/poplin.u3m").decode()
    of_command = native(kesf, work, "-q", "export", "kesf_data/poplin", "--to", "u3m").stdout
    check("a material card is that of the command", words(made) == words(of_command))
    check("there are cards of every program", page.locator("summary", has_text="cards/").count() == len(exporters(kesf)))


def words(card):
    """The lines of a card without its numbers, and without its identifier, which is made of them."""
    lines = [line for line in card.splitlines() if '"id":' not in line]
    return [re.sub(r"-?\d+\.?\d*(e-?\d+)?", "0", line) for line in lines]


def exporters(kesf):
    listed = subprocess.run([kesf, "list", "exports", "--json"], capture_output=True, text=True, check=True).stdout
    # Those without an ending are not written.
    return [item for item in json.loads(listed)["items"] if item["ending"] != "-"]


def first_chart(browser, address, work):
    """Curves of 21 raw files come to the screen; prints after how many seconds."""
    files = [(p.name, p.read_bytes()) for p in sorted((work / "kesf_data/poplin").glob("*.csv"))]
    check("there are 21 raw files", len(files) == 21, len(files))
    took = []
    for _ in range(3):
        page = opened(browser, address)
        begin = drop(page, files)
        frame(page).locator("svg path.curve").first.wait_for(timeout=60_000)
        took.append(time.perf_counter() - begin)
        page.locator("body[data-ended]").wait_for(timeout=60_000)
        took_all = time.perf_counter() - begin
        page.context.close()
    print(f"first chart {', '.join(f'{t:.2f}' for t in took)} s after the drop of 21 files; everything after {took_all:.1f} s")
    # How many seconds that is depends on the machine: the figure is printed, and only a page that hangs fails.


def cancelled(browser, address):
    page = opened(browser, address)
    page.get_by_role("button", name="Load the example").focus()
    page.keyboard.press("Enter")
    page.locator("#stage", has_text="on their way").wait_for(timeout=60_000)
    begin = time.perf_counter()
    page.get_by_role("button", name="Cancel").click()
    # The work itself takes longer; how much sooner this is depends on the machine, and is printed.
    page.locator("#status", has_text="Cancelled").wait_for(timeout=10_000)
    took = time.perf_counter() - begin
    print(f"cancelled after {took:.2f} s")
    check("cancel works at once", took < 5 and page.locator("body[data-busy]").count() == 0, took)
    status = worked(page, lambda: cases_on(page, False))
    check("and the page goes on", status.startswith("Done: 2 fabrics"), status)
    page.context.close()


SETTINGS = 'bending_slope = ["0.3 1/cm", "1.2 1/cm"]\n'


def settings(browser, address, kesf, work, text):
    page = opened(browser, address)
    cases_on(page, False)
    worked(page, lambda: choose_folder(page, work / "kesf_data/poplin"))
    before = rows(downloaded(page, "fabrics.csv"))
    worked(page, lambda: page.locator("#settings").fill(text))
    after = downloaded(page, "fabrics.csv")
    mean = lambda table: next(r["mean"] for r in table if (r["parameter"], r["direction"]) == ("B", "warp"))
    check("settings take effect", mean(before) != mean(rows(after)), mean(before))
    (work / "form").mkdir(exist_ok=True)
    (work / "form/settings.toml").write_text(text)
    native(kesf, work, "-q", "run", "kesf_data/poplin", "-o", "set", "--no-charts", "--settings", "form/settings.toml")
    compared("fabrics.csv with settings", after, (work / "set/fabrics.csv").read_bytes())
    worked(page, lambda: page.locator("#settings").fill("bending_slop = 1\n"))
    (work / "form/settings.toml").write_text("bending_slop = 1\n")
    of_command = native(kesf, work, "run", "kesf_data/poplin", "-o", "bad", "--settings", "form/settings.toml").stderr
    said = texts(page)
    check("a mistake in them is told as by the command", any(line in of_command.splitlines() for line in said), (said, of_command))
    worked(page, lambda: page.locator("#settings").fill(""))
    worked(page, lambda: page.locator("#dialect").fill("nonsense = 1\n"))
    (work / "form/dialect.toml").write_text("nonsense = 1\n")
    of_command = native(kesf, work, "check", "kesf_data/poplin", "--dialect", "form/dialect.toml").stderr
    said = texts(page)
    check("so is one in a dialect", any(line in of_command.splitlines() for line in said), (said, of_command))
    page.context.close()


def texts(page):
    """The messages without the word for their kind, which the command shows by colour."""
    all_ = page.locator("#messages .messages li").all_inner_texts()
    return [text.split(": ", 1)[1] for text in all_]


def bad_files(browser, address, kesf, work):
    folder = work / "bad"
    (folder / "dropped").mkdir(parents=True)
    photo = bytes([0xFF, 0xD8, 0xFF, 0xE0]) + random.Random(1).randbytes(200_000)
    (folder / "photo.jpg").write_bytes(photo)
    (folder / "dropped/zeros.csv").write_bytes(bytes(200 * MB))
    with zipfile.ZipFile(folder / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as bomb:
        bomb.writestr("fb2.csv", bytes(300 * MB))
    whole = (work / "kesf_data/poplin/poplin_warp_FB2_1.csv").read_text(encoding="utf-8")
    lines = whole.splitlines()
    middle = len(lines) // 2
    lines[middle] = lines[middle].replace(lines[middle].split(",")[0], "n.a.?", 1)
    (folder / "dropped/broken.csv").write_text("\n".join(lines), encoding="utf-8")
    (folder / "dropped/poplin_warp_FB2_1.csv").write_text(whole, encoding="utf-8")
    of_command = native(kesf, folder, "check", "bomb.zip", "dropped", "photo.jpg").stderr.splitlines()

    page = opened(browser, address)
    cases_on(page, False)
    names = ["photo.jpg", "dropped/zeros.csv", "bomb.zip", "dropped/broken.csv", "dropped/poplin_warp_FB2_1.csv"]
    status = worked(page, lambda: page.locator("#files").set_input_files([str(folder / name) for name in names]))
    said = texts(page)
    errors = [line for line in of_command if any(name in line for name in ("photo", "zeros", "bomb", "broken"))]
    check("four bad files have their messages", len(errors) >= 4, of_command)
    missing = [line for line in errors if line not in said]
    check("those of the command", not missing, (missing, said))
    check("the page goes on", "Done" in status and page.locator("#fabrics", has_text="poplin_warp_FB2_1.csv").count() == 1, status)
    for line in said:
        print(f"  {line}")
    page.get_by_role("button", name="Start over").click()
    status = worked(page, lambda: drop(page, [("poplin_warp_FB2_1.csv", whole.encode())]))
    check("and takes other files", status.startswith("Done: 1 fabric, 0 errors"), status)
    page.context.close()


def over_the_report(browser, address, work):
    """What is dropped on the frame of the report is taken and the example goes; what is too large stays told."""
    page = opened(browser, address)
    cases_on(page, False)
    worked(page, page.get_by_role("button", name="Load the example").click)
    page.locator("#report").scroll_into_view_if_needed()
    box = page.locator("#report").bounding_box()
    record = work / "kesf_data/poplin/poplin_warp_FB2_1.csv"
    session = page.context.new_cdp_session(page)
    data = {"items": [], "files": [str(record)], "dragOperationsMask": 1}
    inside = (box["x"] + 100, box["y"] + 60)

    def drag():
        for kind, (x, y) in (("dragEnter", (5, 5)), ("dragOver", (5, 5)), ("dragOver", inside), ("dragOver", inside), ("drop", inside)):
            session.send("Input.dispatchDragEvent", {"type": kind, "x": x, "y": y, "data": data})
            page.wait_for_timeout(50)

    status = worked(page, drag)
    check("a drop on the report is taken, without the example", status.startswith("Done: 1 fabric, 0 errors"), status)
    large = work / "large.csv"
    with large.open("wb") as file:
        file.truncate(501 * MB)
    status = worked(page, lambda: page.locator("#files").set_input_files([str(large), str(record)]))
    said = texts(page)
    check("what is too large is told when the rest is done", any("large.csv: the page takes files of up to 500 MB" in line for line in said), said)
    check("and counted", status.startswith("Done: 1 fabric, 1 error"), status)
    page.context.close()


def archives(browser, address, work):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("poplin", "petrak_m1"):
            for path in sorted((work / "kesf_data" / name).iterdir()):
                archive.write(path, f"lab/{name}/{path.name}")
    page = opened(browser, address)
    cases_on(page, False)
    odd = ("<img src=x onerror=alert(1)>.csv", b"a;b\n1;2\n")
    status = worked(page, lambda: drop(page, [("exports.zip", packed.getvalue()), odd]))
    check("a zip is a folder of fabrics", status.startswith("Done: 2 fabrics") or status.startswith("Done: 3 fabrics"), status)
    found = page.locator("details.fabric strong").all_inner_texts()
    check("with the names of their folders", {"poplin", "petrak_m1"} <= set(found), found)
    check("a name of markup is text", page.locator("main img").count() == 0 and "<img" in page.locator("#understood").inner_text())
    page.context.close()


def served(browser, page_path):
    """From a server, which counts what is asked of it."""
    asked = []

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, text, *arguments):
            asked.append(arguments[0])

    handler = functools.partial(Handler, directory=str(page_path.parent))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = opened(browser, f"http://127.0.0.1:{server.server_port}/{page_path.name}")
        cases_on(page, False)
        worked(page, page.get_by_role("button", name="Load the example").click)
        check("a server is asked for the page only", len(asked) == 1, asked)
        refused = page.evaluate("fetch('/secret').then(() => false, () => true)")
        check("the policy forbids any request", refused and len(asked) == 1, asked)
        page.context.set_offline(True)
        status = worked(page, page.locator("#kes-units").check)
        check("it works without a network", status.startswith("Done: 2 fabrics"), status)
        page.context.close()
        server.shutdown()


def looked_at(browser, address, work, pictures):
    for viewport, size in ((DESKTOP, "desktop"), (PHONE, "phone")):
        page = opened(browser, address, viewport, bypass_csp=True)
        worked(page, page.get_by_role("button", name="Load the example").click)
        marks = "['kesf-cases', 'kesf-report'].map((name) => performance.getEntriesByName(name)[0].startTime)"
        first, last = page.evaluate(f"() => {marks}")
        # As with the first chart, how many seconds that is depends on the machine; a minute is the goal.
        print(f"the drape of the example after {(last - first) / 1e3:.1f} s")
        wide = page.evaluate("document.documentElement.scrollWidth - innerWidth")
        check(f"nothing scrolls sideways: {size}", wide <= 0, wide)
        # The page follows the scheme of the reader's machine while it stands.
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            page.locator("details.fabric").first.evaluate("details => { details.open = true; }")
            page.locator("#form").evaluate("form => { form.open = true; }")
            accessible(page, f"{size}, {scheme}")
            page.locator("details").evaluate_all("all => all.forEach((details) => { details.open = false; })")
            if pictures:
                # Those that the book shows have short names.
                name = {("desktop", "light"): "web", ("phone", "light"): "web_phone"}.get((size, scheme), f"web_{size}_{scheme}")
                page.evaluate("scrollTo(0, 0)")
                page.screenshot(path=f"{pictures}/{name}.png")
                page.evaluate("document.querySelector('#results').scrollIntoView()")
                page.wait_for_timeout(300)
                page.screenshot(path=f"{pictures}/{name}_results.png")
        page.context.close()


def main(path, kesf, work, pictures=None):
    path, kesf, work = Path(path).resolve(), str(Path(kesf).resolve()), Path(work)
    address = path.as_uri()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        print(f"Chromium {browser.version}")
        first_chart(browser, address, work)
        cancelled(browser, address)
        settings(browser, address, kesf, work, SETTINGS)
        archives(browser, address, work)
        bad_files(browser, address, kesf, work)
        over_the_report(browser, address, work)
        served(browser, path)
        looked_at(browser, address, work, pictures)
        same_digits(browser, address, kesf, work)
        browser.close()
    print(f"{report.passed} passed, {report.failed} failed")
    return report.failed == 0


if __name__ == "__main__":
    sys.exit(0 if main(*sys.argv[1:]) else 1)
