
// The report as a tool: the table of parameters sorts and filters, curves are drawn and read, fabrics are compared.
// Everything works on the data in the page; nothing is fetched, and without this script the page is still readable.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const state = { si: false };
  const redraw = []; // what is to be drawn again when units change

  // ---- small helpers ------------------------------------------------------------------------------------------

  /** An HTML element with attributes (functions become listeners) and children. Text is never read as markup. */
  function element(name, attributes = {}, ...children) {
    return filled(document.createElement(name), attributes, children);
  }
  /** The same of SVG. */
  function shape(name, attributes = {}, ...children) {
    return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
  }
  function filled(node, attributes, children) {
    for (const [key, value] of Object.entries(attributes)) {
      if (typeof value === "function") node.addEventListener(key, value);
      else if (value === true) node.setAttribute(key, "");
      else if (value !== false && value !== null && value !== undefined) node.setAttribute(key, value);
    }
    node.append(...children);
    return node;
  }
  const checkbox = (text, checked, change) => {
    const box = element("input", { type: "checkbox", checked, change: () => change(box.checked) });
    return element("label", {}, box, " ", text);
  };
  const fieldset = (title, ...children) => element("fieldset", {}, element("legend", {}, title), ...children);

  // ---- numbers as report::number and html::parameters write them ------------------------------------------------

  const decade = (v) => Math.floor(Math.log10(Math.abs(v)) + 1e-9);
  function fixed(v, decimals) {
    const text = v.toFixed(decimals);
    return text.startsWith("-") ? (Number(text) === 0 ? text.slice(1) : "\u2212" + text.slice(1)) : text;
  }
  const power = (e) => "10" + [...String(e)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
  function significant(v, digits = 4) {
    if (v === 0) return "0";
    const e = decade(v);
    if (e >= -3 && e < 6) return fixed(v, Math.max(0, digits - 1 - e));
    return fixed(v / 10 ** e, digits - 1) + " × " + power(e);
  }
  /** Mean ± SD: the SD with two digits, the mean to the same place. */
  function spread(mean, sd) {
    if (!(sd > 0)) return significant(mean);
    let e = mean === 0 ? 0 : decade(mean);
    if (e >= -3 && e < 6) e = 0;
    const [m, s] = e === 0 ? [mean, sd] : [mean / 10 ** e, sd / 10 ** e];
    const decimals = Math.min(8, Math.max(0, 1 - decade(s)));
    const text = fixed(m, decimals) + " ± " + fixed(s, decimals);
    return e === 0 ? text : `(${text}) × ${power(e)}`;
  }
  const factor = (column) => (state.si ? 1 : column.factor);
  const unit = (column) => (state.si ? column.si : column.kes);
  /** A value in the chosen unit, without the noise of the conversion. */
  const converted = (v, by) => (by === 1 ? v : Number((v / by).toPrecision(12)));
  const label = (column) => column.symbol + (column.direction ? " " + column.direction : "");

  // ---- the table of parameters --------------------------------------------------------------------------------

  const table = document.getElementById("parameters");
  const PAGE = 100; // rows that are shown at once
  const rows = []; // { fabric, row, cells } in the order of the data
  const view = { column: -1, descending: false, limit: PAGE, hiddenTests: new Set(), hiddenDirections: new Set() };
  const controls = {};

  function columnIsShown(column) {
    return !view.hiddenTests.has(column.test) && !view.hiddenDirections.has(column.direction ?? "whole");
  }

  function fabricIsShown(fabric) {
    const words = controls.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const text = (fabric.name + " " + fabric.about).toLowerCase();
    if (!words.every((word) => text.includes(word))) return false;
    const values = Object.values(fabric.values);
    const status = controls.status.value;
    if (status && !values.some((v) => v.status === status)) return false;
    const [from, to] = [controls.from.value, controls.to.value];
    if (from === "" && to === "") return true;
    const value = fabric.values[controls.column.value];
    if (!value) return false;
    const shown = value.mean / factor(data.columns[controls.column.value]);
    return !(from !== "" && shown < Number(from)) && !(to !== "" && shown > Number(to));
  }

  /** Rows that pass the filters, in the chosen order; fabrics without the value come last either way. */
  function chosenRows() {
    const chosen = rows.filter((r) => fabricIsShown(r.fabric));
    if (view.column < 0) {
      if (view.descending) chosen.reverse();
      return chosen;
    }
    const mean = (r) => r.fabric.values[view.column]?.mean;
    const sign = view.descending ? -1 : 1;
    return chosen.sort((a, b) => {
      const [x, y] = [mean(a), mean(b)];
      if (x === undefined || y === undefined) return (x === undefined) - (y === undefined);
      return sign * (x - y);
    });
  }

  function showTable() {
    const chosen = chosenRows();
    const shown = chosen.slice(0, view.limit);
    const body = table.tBodies[0];
    body.replaceChildren(...shown.map((r) => r.row));
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, i) => {
      const order = i - 1 !== view.column ? "none" : view.descending ? "descending" : "ascending";
      head.setAttribute("aria-sort", order);
    });
    controls.count.textContent = `${chosen.length} of ${rows.length} fabrics`;
    controls.more.hidden = chosen.length <= view.limit;
  }

  function showColumns() {
    const heads = table.tHead.rows[0].cells;
    data.columns.forEach((column, i) => {
      const hidden = !columnIsShown(column);
      heads[i + 1].hidden = hidden;
      rows.forEach((r) => { r.row.cells[i + 1].hidden = hidden; });
    });
  }

  function showUnits() {
    document.documentElement.classList.toggle("units-si", state.si);
    const heads = table?.tHead.rows[0].cells ?? [];
    data.columns.forEach((column, i) => {
      heads[i + 1].querySelector("small").textContent = unit(column);
      for (const { fabric, row } of rows) {
        const value = fabric.values[i];
        if (!value) continue;
        const by = factor(column);
        row.cells[i + 1].firstChild.nodeValue = spread(value.mean / by, value.sd == null ? null : value.sd / by);
      }
    });
    redraw.forEach((draw) => draw());
  }

  function sortBy(column) {
    if (view.column === column) view.descending = !view.descending;
    else [view.column, view.descending] = [column, column >= 0];
    showTable();
  }

  /** A cell of CSV; what a spreadsheet would take for a formula begins with an apostrophe. */
  function csvCell(value) {
    let text = String(value ?? "");
    if (typeof value !== "number" && /^[=+\-@\t\r]/.test(text)) text = "'" + text;
    return /[",\n\r]/.test(text) ? '"' + text.replaceAll('"', '""') + '"' : text;
  }

  /** One observation a line, of what is shown, in the chosen units; columns named as in fabrics.csv. */
  function csvText() {
    const lines = [["fabric", "parameter", "direction", "mean", "sd", "n", "unit", "status"]];
    for (const { fabric } of chosenRows()) {
      data.columns.forEach((column, i) => {
        const value = fabric.values[i];
        if (!value || !columnIsShown(column)) return;
        const [mean, sd] = [value.mean, value.sd].map((v) => (v == null ? "" : converted(v, factor(column))));
        const written = unit(column) || "1";
        lines.push([fabric.name, column.symbol, column.direction, mean, sd, value.n, written, value.status]);
      });
    }
    return lines.map((line) => line.map(csvCell).join(",") + "\r\n").join("");
  }

  /** What is shown as a table for a spreadsheet: means, tab-separated. */
  function copyText() {
    const columns = data.columns.map((column, i) => [column, i]).filter(([column]) => columnIsShown(column));
    const head = ["fabric", ...columns.map(([c]) => label(c) + (unit(c) ? ` (${unit(c)})` : ""))];
    const lines = chosenRows().map(({ fabric }) => [
      fabric.name,
      ...columns.map(([c, i]) => (fabric.values[i] ? converted(fabric.values[i].mean, factor(c)) : "")),
    ]);
    const cell = (v) => (typeof v === "number" ? String(v) : csvCell(v.replaceAll("\t", " ")));
    return [head, ...lines].map((line) => line.map(cell).join("\t")).join("\n") + "\n";
  }

  function download() {
    // The mark at the start tells Excel that the text is UTF-8.
    const url = URL.createObjectURL(new Blob(["\ufeff" + csvText()], { type: "text/csv;charset=utf-8" }));
    const name = `parameters_${state.si ? "si" : "kes"}.csv`;
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }

  async function copy(button) {
    const text = copyText();
    let done = true;
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // Older browsers, and pages that may not use the clipboard by themselves.
      const area = element("textarea", { "aria-hidden": "true" }, text);
      document.body.append(area);
      area.select();
      done = document.execCommand("copy");
      area.remove();
    }
    button.textContent = done ? "Copied" : "The browser refused";
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  }

  function unitSwitch() {
    const buttons = [["KES units", false], ["SI", true]].map(([text, si]) =>
      element("button", { type: "button", "aria-pressed": String(si === state.si), click: () => {
        state.si = si;
        buttons.forEach((b, i) => b.setAttribute("aria-pressed", String((i === 1) === si)));
        showUnits();
        if (table) showTable();
      } }, text));
    return element("div", { role: "group", "aria-label": "Units" }, ...buttons);
  }

  function tableControls() {
    const again = () => { view.limit = PAGE; showTable(); };
    const option = (value, text) => element("option", { value }, text);
    const statuses = ["inferred", "assumed", "doubtful"].map((s) => option(s, `with ${s} values`));
    Object.assign(controls, {
      search: element("input", { type: "search", placeholder: "Search fabrics", "aria-label": "Search fabrics", input: again }),
      status: element("select", { "aria-label": "Status", change: again }, option("", "any status"), ...statuses),
      column: element("select", { "aria-label": "Parameter to filter by", change: again },
        ...data.columns.map((c, i) => option(i, label(c)))),
      from: element("input", { type: "number", step: "any", placeholder: "from", "aria-label": "from, in the chosen unit", input: again }),
      to: element("input", { type: "number", step: "any", placeholder: "to", "aria-label": "to, in the chosen unit", input: again }),
      count: element("span", { role: "status" }),
      more: element("button", { type: "button", click: () => { view.limit += PAGE; showTable(); } }, "Show more"),
    });
    const toggles = (title, names, hidden) => fieldset(title, ...names.map((name) =>
      checkbox(name, true, (on) => { if (on) hidden.delete(name); else hidden.add(name); showColumns(); })));
    const tests = [...new Set(data.columns.map((c) => c.test))];
    const directions = [...new Set(data.columns.map((c) => c.direction ?? "whole"))];
    const copyButton = element("button", { type: "button", click: () => copy(copyButton) }, "Copy");
    table.parentElement.before(
      element("div", { class: "controls" }, unitSwitch(), controls.search, controls.status,
        fieldset("Range", controls.column, controls.from, controls.to)),
      element("div", { class: "controls" }, toggles("Tests", tests, view.hiddenTests),
        toggles("Directions", directions, view.hiddenDirections), copyButton,
        element("button", { type: "button", click: download }, "Download CSV"), controls.count));
    table.parentElement.after(controls.more);
  }

  function startTable() {
    [...table.tBodies[0].rows].forEach((row, i) => rows.push({ fabric: data.fabrics[i], row }));
    [...table.tHead.rows[0].cells].forEach((head, i) => {
      const button = element("button", { type: "button", click: () => sortBy(i - 1) }, head.firstChild.nodeValue);
      head.firstChild.replaceWith(button);
    });
    tableControls();
    showTable();
  }

  // ---- fabrics open by link -----------------------------------------------------------------------------------

  function openLinked() {
    const id = location.hash.slice(1);
    const part = id && document.getElementById(id);
    if (part instanceof HTMLDetailsElement) {
      part.open = true;
      part.scrollIntoView();
    }
  }

  // ---- axes ---------------------------------------------------------------------------------------------------

  /** Round values within a range, about `count` of them. */
  function ticks([low, high], count) {
    const raw = (high - low) / count;
    const base = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((k) => k * base).find((s) => s >= raw);
    const found = [];
    for (let i = Math.ceil(low / step); i * step <= high + 1e-9 * step; i++) found.push(i * step);
    return [found, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))];
  }
  function extent(values) {
    let [low, high] = [Infinity, -Infinity];
    for (const v of values) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
    const margin = high > low ? 0.04 * (high - low) : Math.abs(high) || 1;
    return [low - margin, high + margin];
  }

  // ---- curves of tests ----------------------------------------------------------------------------------------

  const FRAME = { width: 640, height: 420, left: 66, right: 12, top: 10, bottom: 46 };
  const dashes = { warp: "", weft: "7 4", bias: "2 3" };

  /** A chart of one test: measured loops, windows of the fits, simulated curves; hover, zoom, switches. */
  class Chart {
    constructor(curves, fabric) {
      this.curves = curves;
      this.zoom = null;
      this.traces = [
        ...curves.specimens.map((s) => ({
          name: `${s.direction ? s.direction + ", " : ""}specimen ${s.specimen}`, direction: s.direction,
          lines: s.branches, windows: s.windows, on: true, simulated: false })),
        ...curves.simulated.map((s) => ({
          name: `${s.direction ? s.direction + ", " : ""}${s.label}`, direction: s.direction,
          lines: [s.line], windows: [], on: true, simulated: true, friction: s.label.endsWith("friction") })),
      ];
      const name = `${curves.test} of ${fabric.name}: ${curves.specimens.length} measured specimens, ` +
        `${curves.simulated.length} simulated curves. Arrow keys read values, plus and minus zoom, 0 resets.`;
      this.svg = shape("svg", { viewBox: `0 0 ${FRAME.width} ${FRAME.height}`, role: "application",
        "aria-label": name, tabindex: "0" });
      this.reading = element("div", { class: "reading", role: "status" });
      this.at = 0; // the point that the keyboard reads
      this.listen();
      const keys = element("div", { class: "keys" }, ...this.traces.map((t) => this.key(t)));
      this.windows = true;
      if (curves.specimens.some((s) => s.windows.length)) {
        keys.append(checkbox("windows of the fits", true, (on) => { this.windows = on; this.draw(); }));
      }
      const remark = curves.specimens.length ? "" : " (no curve recorded, simulated only)";
      this.node = element("div", { class: "chart" },
        element("h4", {}, curves.test + remark), this.svg, this.reading, keys);
      redraw.push(() => this.draw());
      this.draw();
    }
    key(trace) {
      const sample = shape("svg", { viewBox: "0 0 32 10", "aria-hidden": "true" },
        shape("path", { d: "M0 5H32", ...this.stroke(trace) }));
      const switched = checkbox(trace.name, true, (on) => { trace.on = on; this.draw(); });
      switched.insertBefore(sample, switched.lastChild);
      return switched;
    }
    stroke(trace) {
      const kind = (trace.simulated ? " simulated" : "") + (trace.friction ? " friction" : "");
      return { class: `curve ${trace.direction ?? "none"}${kind}`, "stroke-dasharray": trace.simulated ? null : dashes[trace.direction] };
    }
    get axes() { return this.curves.axes.map((a) => ({ quantity: a.quantity, unit: (state.si ? a.si : a.kes)[0], by: (state.si ? a.si : a.kes)[1] })); }
    /** Ranges in SI: those of everything that is switched on, or the zoom. */
    ranges() {
      if (this.zoom) return this.zoom;
      const on = this.traces.filter((t) => t.on).flatMap((t) => t.lines);
      if (!on.length) return [[0, 1], [0, 1]];
      return [extent(on.flatMap((l) => l.x)), extent(on.flatMap((l) => l.y))];
    }
    place([rx, ry]) {
      const w = FRAME.width - FRAME.left - FRAME.right, h = FRAME.height - FRAME.top - FRAME.bottom;
      return {
        x: (v) => FRAME.left + ((v - rx[0]) / (rx[1] - rx[0])) * w,
        y: (v) => FRAME.top + h - ((v - ry[0]) / (ry[1] - ry[0])) * h,
        backX: (p) => rx[0] + ((p - FRAME.left) / w) * (rx[1] - rx[0]),
        backY: (p) => ry[0] + ((FRAME.top + h - p) / h) * (ry[1] - ry[0]),
      };
    }
    draw() {
      const ranges = this.ranges(), at = this.place(ranges), axes = this.axes;
      this.scale = at;
      const parts = [this.frame(ranges, at, axes)];
      const inside = shape("svg", { x: FRAME.left, y: FRAME.top, width: FRAME.width - FRAME.left - FRAME.right,
        height: FRAME.height - FRAME.top - FRAME.bottom,
        viewBox: `${FRAME.left} ${FRAME.top} ${FRAME.width - FRAME.left - FRAME.right} ${FRAME.height - FRAME.top - FRAME.bottom}` });
      const path = (l) => "M" + l.x.map((x, i) => `${at.x(x).toFixed(1)} ${at.y(l.y[i]).toFixed(1)}`).join("L");
      const on = this.traces.filter((t) => t.on);
      if (this.windows) inside.append(...this.shaded(on.flatMap((t) => t.windows), at));
      for (const t of on) {
        if (this.windows) inside.append(...t.windows.map((w) => this.fit(w, at)));
        for (const l of t.lines) if (l.x.length) inside.append(shape("path", { d: path(l), ...this.stroke(t) }));
      }
      this.cursor = shape("g", {});
      inside.append(this.cursor);
      this.svg.replaceChildren(...parts, inside);
    }
    /** The line of a fit, or the bar of a width that is read at one abscissa. */
    fit([symbol, [from, to], [low, high]], at) {
      return shape("path", { class: "fit", d: `M${at.x(from)} ${at.y(low)}L${at.x(to)} ${at.y(high)}` }, shape("title", {}, symbol));
    }
    /** The windows of the fits, once each: specimens share them. */
    shaded(windows, at) {
      const bands = new Map();
      for (const [symbol, [from, to]] of windows) {
        if (from === to) continue;
        const [left, right] = [at.x(from), at.x(to)].sort((a, b) => a - b);
        bands.set(`${left.toFixed(0)} ${right.toFixed(0)}`, [symbol, left, right]);
      }
      const height = FRAME.height - FRAME.top - FRAME.bottom;
      return [...bands.values()].map(([symbol, left, right]) => shape("rect",
        { class: "window", x: left, y: FRAME.top, width: right - left, height }, shape("title", {}, `window of ${symbol}`)));
    }
    frame(ranges, at, axes) {
      const group = shape("g", {});
      const [right, bottom] = [FRAME.width - FRAME.right, FRAME.height - FRAME.bottom];
      ranges.forEach((range, i) => {
        const by = axes[i].by;
        const [values, decimals] = ticks([range[0] / by, range[1] / by], i ? 6 : 7);
        for (const v of values) {
          const p = i ? at.y(v * by) : at.x(v * by);
          group.append(shape("path", { class: "grid", d: i ? `M${FRAME.left} ${p}H${right}` : `M${p} ${FRAME.top}V${bottom}` }),
            shape("text", i ? { x: FRAME.left - 6, y: p + 4, "text-anchor": "end" } : { x: p, y: bottom + 16, "text-anchor": "middle" },
              fixed(v, decimals)));
        }
      });
      const named = (a) => a.quantity + (a.unit ? ` (${a.unit})` : "");
      group.append(shape("rect", { class: "axis", x: FRAME.left, y: FRAME.top, width: right - FRAME.left, height: bottom - FRAME.top }),
        shape("text", { class: "soft", x: (FRAME.left + right) / 2, y: FRAME.height - 8, "text-anchor": "middle" }, named(axes[0])),
        shape("text", { class: "soft", x: 0, y: 0, transform: `translate(14 ${(FRAME.top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, named(axes[1])));
      return group;
    }
    /** Every point that is shown: trace, SI values. */
    points() {
      const found = [];
      for (const t of this.traces.filter((t) => t.on)) for (const l of t.lines) l.x.forEach((x, i) => found.push([t, x, l.y[i]]));
      return found;
    }
    read([trace, x, y]) {
      const values = this.axes.map((a, i) => `${a.quantity} ${significant((i ? y : x) / a.by)}${a.unit ? " " + a.unit : ""}`);
      this.reading.textContent = `${trace.name}: ${values.join(", ")}`;
      this.cursor.replaceChildren(shape("circle", { cx: this.scale.x(x), cy: this.scale.y(y), r: 5, class: `curve ${trace.direction ?? "none"}` }));
    }
    /** Where a pointer is, in the units of the drawing. */
    pointer(event) {
      const box = this.svg.getBoundingClientRect();
      return [(event.clientX - box.left) * (FRAME.width / box.width), (event.clientY - box.top) * (FRAME.height / box.height)];
    }
    hover([px, py]) {
      let best = null, distance = 30 ** 2;
      for (const point of this.points()) {
        const d = (this.scale.x(point[1]) - px) ** 2 + (this.scale.y(point[2]) - py) ** 2;
        if (d < distance) [best, distance] = [point, d];
      }
      if (best) this.read(best);
    }
    listen() {
      let start = null;
      this.svg.addEventListener("pointerdown", (e) => {
        if (e.button !== 0 || e.pointerType === "touch") return;
        start = this.pointer(e);
        this.svg.setPointerCapture(e.pointerId);
      });
      this.svg.addEventListener("pointermove", (e) => {
        const here = this.pointer(e);
        if (!start) return this.hover(here);
        const [x, y, w, h] = [0, 1].map((i) => Math.min(start[i], here[i])).concat([0, 1].map((i) => Math.abs(start[i] - here[i])));
        this.cursor.replaceChildren(shape("rect", { class: "box", x, y, width: w, height: h }));
      });
      this.svg.addEventListener("pointerup", (e) => {
        if (!start) return;
        const [from, end] = [start, this.pointer(e)];
        start = null;
        if (Math.abs(from[0] - end[0]) < 8 || Math.abs(from[1] - end[1]) < 8) return this.cursor.replaceChildren();
        const sorted = (a, b) => [Math.min(a, b), Math.max(a, b)];
        this.zoom = [sorted(this.scale.backX(from[0]), this.scale.backX(end[0])), sorted(this.scale.backY(from[1]), this.scale.backY(end[1]))];
        this.draw();
      });
      this.svg.addEventListener("dblclick", () => { this.zoom = null; this.draw(); });
      this.svg.addEventListener("keydown", (e) => this.press(e));
    }
    press(event) {
      const step = { ArrowRight: 1, ArrowLeft: -1, ArrowUp: 10, ArrowDown: -10 }[event.key];
      const points = this.points();
      if (step && points.length) {
        this.at = (this.at + step + points.length) % points.length;
        this.read(points[this.at]);
      } else if (event.key === "0") {
        this.zoom = null;
        this.draw();
      } else if (event.key === "+" || event.key === "-") {
        const by = event.key === "+" ? 0.25 : -0.5;
        this.zoom = this.ranges().map(([a, b]) => [a + by * (b - a), b - by * (b - a)]);
        this.draw();
      } else return;
      event.preventDefault();
    }
  }

  /** Charts are made when their fabric is opened: a page of many fabrics begins at once. */
  function startCurves() {
    for (const place of document.querySelectorAll(".curves")) {
      const index = Number(place.dataset.fabric);
      const fill = () => {
        if (place.childElementCount || !place.closest("details").open) return;
        const mine = data.curves.filter((c) => c.fabric === index);
        place.append(element("p", {}, "Drag to zoom, double click to reset; the nearest point is read below the chart. Dashed and thick: simulated."),
          element("div", { class: "charts" }, ...mine.map((c) => new Chart(c, data.fabrics[index]).node)));
      };
      place.closest("details").addEventListener("toggle", fill);
      fill();
    }
  }

  // ---- control chart and nearest fabrics ----------------------------------------------------------------------

  const LEAST_POPULATION = 3; // fabrics behind a mean and SD
  const LEAST_SHARED = 3; // parameters behind a distance

  /** The 16 parameters of the hand equations that occur: mean and SD of the population and z of each fabric. */
  function standardised() {
    const symbols = [...new Set(data.columns.filter((c) => c.log !== null).map((c) => c.symbol))];
    return symbols.map((symbol) => {
      const columns = data.columns.map((c, i) => [c, i]).filter(([c]) => c.symbol === symbol);
      const log = columns[0][0].log;
      const place = (direction) => columns.find(([c]) => c.direction === direction)?.[1];
      const mean = (fabric, direction) => fabric.values[place(direction)]?.mean;
      const values = data.fabrics.map((fabric) => {
        const [warp, weft] = [mean(fabric, "warp"), mean(fabric, "weft")];
        const value = warp !== undefined && weft !== undefined ? (warp + weft) / 2 : mean(fabric, null);
        if (value === undefined || (log && !(value > 0))) return undefined;
        // In KES units, as the equations take them; the z does not depend on it.
        return log ? Math.log10(value / columns[0][0].factor) : value / columns[0][0].factor;
      });
      const known = values.filter((v) => v !== undefined);
      const n = known.length;
      const average = known.reduce((a, b) => a + b, 0) / n;
      const sd = Math.sqrt(known.reduce((a, b) => a + (b - average) ** 2, 0) / (n - 1));
      const usable = n >= LEAST_POPULATION && sd > 1e-9 * Math.abs(average || 1);
      const z = usable ? values.map((v) => (v === undefined ? undefined : (v - average) / sd)) : [];
      return { name: (log ? "log " : "") + symbol, n, usable, z };
    });
  }

  /** The other fabrics by the root mean square difference of their standardised parameters. */
  function nearest(parameters, fabric) {
    const found = [];
    data.fabrics.forEach((other, i) => {
      if (i === fabric) return;
      const shared = parameters.filter((p) => p.z[i] !== undefined && p.z[fabric] !== undefined);
      if (shared.length < LEAST_SHARED) return;
      const sum = shared.reduce((a, p) => a + (p.z[i] - p.z[fabric]) ** 2, 0);
      found.push({ name: other.name, distance: Math.sqrt(sum / shared.length), shared: shared.length });
    });
    return found.sort((a, b) => a.distance - b.distance);
  }

  function startControlChart() {
    const place = document.getElementById("control-chart");
    if (!place) return;
    const all = standardised();
    const parameters = all.filter((p) => p.usable);
    const unusable = all.filter((p) => !p.usable).map((p) => `${p.name} (n ${p.n})`);
    if (!parameters.length) {
      place.append(element("p", {}, `A control chart needs a parameter that ${LEAST_POPULATION} fabrics have.`));
      return;
    }
    const known = (i) => parameters.filter((p) => p.z[i] !== undefined).length;
    const order = data.fabrics.map((_, i) => i).sort((a, b) => known(b) - known(a));
    const selects = [0, 1, 2, 3].map((k) => element("select", { "aria-label": `Fabric ${k + 1}`, change: show },
      element("option", { value: "" }, "–"),
      ...data.fabrics.map((f, i) => element("option", { value: i, selected: k < 2 && order[k] === i }, f.name))));
    const chart = element("div", { class: "chart" }), lists = element("div", {});
    place.append(element("p", {}, "The parameters of the hand equations (Kawabata 1980), mean of warp and weft, logarithms where the " +
        "equations take them, as standard deviations from a population. The population is the fabrics of this run " +
        `(n = ${data.fabrics.length}; n of each parameter stands beside it), no reference of a trade.` +
        (unusable.length ? ` Left out, with fewer than ${LEAST_POPULATION} different values: ${unusable.join(", ")}.` : "")),
      element("div", { class: "controls" }, ...selects), chart, lists);

    function show() {
      const chosen = selects.map((s) => s.value).map((v, k) => [v, k]).filter(([v]) => v !== "").map(([v, k]) => [Number(v), k]);
      const reach = Math.max(3, ...parameters.flatMap((p) => chosen.map(([i]) => Math.abs(p.z[i] ?? 0)))) + 0.2;
      const width = 640, left = 118, right = 14, step = 26, bottom = 12 + parameters.length * step;
      const x = (z) => left + ((z + reach) / (2 * reach)) * (width - left - right);
      const y = (row) => 12 + (row + 0.5) * step;
      const parts = [];
      for (let z = -Math.floor(reach); z <= reach; z++) {
        parts.push(shape("path", { class: z ? "grid" : "axis", d: `M${x(z)} 8V${bottom}` }),
          shape("text", { x: x(z), y: bottom + 16, "text-anchor": "middle" }, fixed(z, 0)));
      }
      parameters.forEach((p, row) => parts.push(shape("text", { x: left - 8, y: y(row) + 4, "text-anchor": "end" }, `${p.name} (n ${p.n})`)));
      for (const [i, k] of chosen) {
        const points = parameters.map((p, row) => [p.z[i], row]).filter(([z]) => z !== undefined).map(([z, row]) => [x(z), y(row), z]);
        parts.push(shape("path", { class: `line p${k} ${["", "second", "third", ""][k]}`, d: "M" + points.map((p) => `${p[0]} ${p[1]}`).join("L") }));
        for (const [px, py, z] of points) {
          parts.push(shape("circle", { class: `p${k}`, cx: px, cy: py, r: 4 }, shape("title", {}, `${data.fabrics[i].name}: ${fixed(z, 2)} SD`)));
        }
      }
      parts.push(shape("text", { class: "soft", x: (left + width - right) / 2, y: bottom + 34, "text-anchor": "middle" }, "standard deviations from the mean of the population"));
      const names = chosen.map(([i]) => data.fabrics[i].name).join(", ");
      const key = ([i, k]) => element("span", {}, shape("svg", { viewBox: "0 0 32 10", "aria-hidden": "true" },
        shape("path", { class: `line p${k} ${["", "second", "third", ""][k]}`, d: "M0 5H32" })), " " + data.fabrics[i].name);
      chart.replaceChildren(shape("svg", { viewBox: `0 0 ${width} ${bottom + 42}`, role: "img", "aria-label": `Control chart of ${names}; the values are in the table below` }, ...parts),
        element("div", { class: "keys" }, ...chosen.map(key)));
      lists.replaceChildren(valueTable(chosen), ...chosen.map(([i]) => nearestText(i)));
    }
    function valueTable(chosen) {
      const row = (p) => element("tr", {}, element("th", { scope: "row" }, p.name),
        ...chosen.map(([i]) => element("td", { class: "number" }, p.z[i] === undefined ? "–" : fixed(p.z[i], 2))));
      const head = ["parameter", ...chosen.map(([i]) => data.fabrics[i].name)].map((t) => element("th", { scope: "col" }, t));
      return element("details", {}, element("summary", {}, "Values of the chart"), element("div", { class: "wide", tabindex: "0", role: "region", "aria-label": "Values of the chart" },
        element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...parameters.map(row)))));
    }
    function nearestText(i) {
      const found = nearest(parameters, i).slice(0, 3);
      const list = found.map((f) => `${f.name} (${fixed(f.distance, 2)} SD over ${f.shared} parameters)`);
      const text = list.length ? list.join("; ") : `none shares ${LEAST_SHARED} parameters with it`;
      return element("p", { class: "nearest" }, element("b", {}, `Nearest to ${data.fabrics[i].name}: `), text + ".");
    }
    show();
  }

  if (table) startTable();
  startCurves();
  startControlChart();
  window.addEventListener("hashchange", openLinked);
  openLinked();
})();
