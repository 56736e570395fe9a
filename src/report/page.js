
// The report as a tool: the table of parameters sorts and filters, curves are drawn and read, fabrics are compared.
// Everything works on the data in the page; nothing is fetched, and without this script the page is still readable.
"use strict";
const report = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const state = { si: false };
  const redraw = []; // what is to be drawn again when units change
  const followers = []; // what is told which rows the table shows
  const fillers = []; // what fills the parts of fabrics once they are open

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
  const button = (text, label, click) => element("button", { type: "button", "aria-label": label, click }, text);
  const counted = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
  /** A name that is broken after its underscores rather than within a word. */
  const breakable = (name) => name.split(/(?<=_)/).flatMap((part, i) => (i ? [document.createElement("wbr"), part] : [part]));
  const PAINT = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-family", "font-size"];
  /** Gives a drawing away as a file: what the styles of the page do to it stands in it as attributes. */
  function saveSvg(drawing, name) {
    const copy = drawing.cloneNode(true), nodes = (svg) => [svg, ...svg.querySelectorAll("*")];
    nodes(drawing).forEach((node, i) => {
      const style = getComputedStyle(node);
      for (const key of PAINT) nodes(copy)[i].setAttribute(key, style.getPropertyValue(key));
    });
    const [, , width, height] = drawing.getAttribute("viewBox").split(" ");
    copy.setAttribute("width", width);
    copy.setAttribute("height", height);
    copy.prepend(shape("rect", { width, height, fill: getComputedStyle(document.body).backgroundColor }));
    save(new XMLSerializer().serializeToString(copy), "image/svg+xml", name.replace(/[^\p{L}\p{N}._-]+/gu, "_") + ".svg");
  }
  const svgButton = (drawing, name) => button("Save SVG", `Save SVG of ${name()}`, () => saveSvg(drawing(), name()));
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
  /** Four digits at most, without zeros at the end: what was printed as 0.067 is not 0.06700. */
  function concise(v) {
    const [digits, ...rest] = significant(v).split(" × ");
    return [digits.includes(".") ? digits.replace(/\.?0+$/, "") : digits, ...rest].join(" × ");
  }
  /** Mean ± SD: the SD with two digits, the mean to the same place. */
  function spread(mean, sd) {
    if (!(sd > 0)) return concise(mean);
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
  /** The status of what is less than measured, the most certain first. */
  const MARKED = ["inferred", "assumed", "doubtful"];
  const isMarked = (status) => MARKED.includes(status);
  /** A fabric with what its data are: `poplin (synthetic)`. */
  const withOrigin = (fabric) => fabric.name + (fabric.origin ? ` (${fabric.origin})` : "");
  const label = (column) => column.symbol + (column.direction ? " " + column.direction : "");

  // ---- the table of parameters --------------------------------------------------------------------------------

  const table = document.getElementById("parameters");
  const PAGE = 100; // rows that are shown at once
  const FIRST = 2; // columns before those of the parameters: name and origin
  const [NAME, ORIGIN] = [-2, -1]; // what the table is sorted by, where it is no parameter
  const rows = []; // { fabric, row } in the order of the data
  const view = { column: NAME, descending: false, limit: PAGE, hiddenTests: new Set(), hiddenDirections: new Set() };
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
    const origin = controls.origin.value;
    if (origin && fabric.origin !== origin) return false;
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
    const sign = view.descending ? -1 : 1;
    if (view.column === NAME) return view.descending ? chosen.reverse() : chosen;
    if (view.column === ORIGIN) return chosen.sort((a, b) => sign * a.fabric.origin.localeCompare(b.fabric.origin));
    const mean = (r) => r.fabric.values[view.column]?.mean;
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
      const order = i - FIRST !== view.column ? "none" : view.descending ? "descending" : "ascending";
      head.setAttribute("aria-sort", order);
    });
    controls.count.textContent = `${chosen.length} of ${rows.length} fabrics`;
    controls.more.hidden = chosen.length <= view.limit;
    followers.forEach((follow) => follow(chosen));
  }

  function showColumns() {
    const heads = table.tHead.rows[0].cells;
    data.columns.forEach((column, i) => {
      const hidden = !columnIsShown(column);
      heads[i + FIRST].hidden = hidden;
      rows.forEach((r) => { r.row.cells[i + FIRST].hidden = hidden; });
    });
  }

  function showUnits() {
    document.documentElement.classList.toggle("units-si", state.si);
    const heads = table?.tHead.rows[0].cells ?? [];
    data.columns.forEach((column, i) => {
      heads[i + FIRST].querySelector("small").textContent = unit(column);
      for (const { fabric, row } of rows) {
        const value = fabric.values[i];
        if (!value) continue;
        const by = factor(column);
        row.cells[i + FIRST].firstChild.nodeValue = spread(value.mean / by, value.sd == null ? null : value.sd / by);
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
    const lines = [["fabric", "parameter", "direction", "mean", "sd", "n", "unit", "status", "origin"]];
    for (const { fabric } of chosenRows()) {
      data.columns.forEach((column, i) => {
        const value = fabric.values[i];
        if (!value || !columnIsShown(column)) return;
        const [mean, sd] = [value.mean, value.sd].map((v) => (v == null ? "" : converted(v, factor(column))));
        const written = unit(column) || "1";
        lines.push([fabric.name, column.symbol, column.direction, mean, sd, value.n, written, value.status, fabric.origin]);
      });
    }
    return lines.map((line) => line.map(csvCell).join(",") + "\r\n").join("");
  }

  /** What is shown as a table for a spreadsheet: means, tab-separated. */
  function copyText() {
    const columns = data.columns.map((column, i) => [column, i]).filter(([column]) => columnIsShown(column));
    const chosen = chosenRows();
    // What a column holds beside measured values stands in a column of its own behind it, so that numbers stay numbers.
    const marked = ([, i]) => chosen.some(({ fabric }) => isMarked(fabric.values[i]?.status));
    const head = ["fabric", "origin", ...columns.flatMap(([c, i]) => [label(c) + (unit(c) ? ` (${unit(c)})` : ""), ...(marked([c, i]) ? [`${label(c)} status`] : [])])];
    const lines = chosen.map(({ fabric }) => [
      fabric.name,
      fabric.origin,
      ...columns.flatMap(([c, i]) => {
        const value = fabric.values[i];
        return [value ? converted(value.mean, factor(c)) : "", ...(marked([c, i]) ? [value?.status ?? ""] : [])];
      }),
    ]);
    const cell = (v) => (typeof v === "number" ? String(v) : csvCell(v.replaceAll("\t", " ")));
    return [head, ...lines].map((line) => line.map(cell).join("\t")).join("\n") + "\n";
  }

  function save(content, type, name) {
    const url = URL.createObjectURL(new Blob([content], { type }));
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }
  const download = (content, type, ending) => save(content, type, `parameters_${state.si ? "si" : "kes"}.${ending}`);

  // The mark at the start tells Excel that the text is UTF-8.
  const downloadCsv = () => download("\ufeff" + csvText(), "text/csv;charset=utf-8", "csv");

  const XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet";
  const workbooks = document.getElementById("workbooks");

  /** The workbook that the program made: every fabric of the page, in the chosen units. */
  function downloadXlsx() {
    const base64 = JSON.parse(workbooks.textContent)[state.si ? "si" : "kes"];
    download(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)), XLSX, "xlsx");
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
    const origins = [...new Set(data.fabrics.map((f) => f.origin))].filter(Boolean).map((o) => option(o, `${o} fabrics`));
    Object.assign(controls, {
      search: element("input", { type: "search", placeholder: "Search fabrics", "aria-label": "Search fabrics", input: again }),
      status: element("select", { "aria-label": "Status", change: again }, option("", "any status"), ...statuses),
      origin: element("select", { "aria-label": "Origin", change: again }, option("", "any origin"), ...origins),
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
      element("div", { class: "controls" }, unitSwitch(), controls.search, controls.origin, controls.status, copyButton,
        button("CSV", "Download CSV", downloadCsv), ...(workbooks ? [button("XLSX", "Download XLSX, all fabrics", downloadXlsx)] : []),
        controls.count),
      element("details", { class: "more" }, element("summary", {}, "Columns and range"), element("div", { class: "controls" },
        toggles("Tests", tests, view.hiddenTests), toggles("Directions", directions, view.hiddenDirections),
        fieldset("Range", controls.column, controls.from, controls.to))));
    table.parentElement.after(controls.more);
  }

  function startTable() {
    [...table.tBodies[0].rows].forEach((row, i) => rows.push({ fabric: data.fabrics[i], row }));
    [...table.tHead.rows[0].cells].forEach((head, i) => {
      const button = element("button", { type: "button", click: () => sortBy(i - FIRST) }, head.firstChild.nodeValue);
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
      part.hidden = false; // a link leads to what a filter left out, too
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

  const LARGEST = 640, SMALLEST = 280; // units of a drawing, as many as its place has pixels: text is then as large as that around it
  const wide = (place) => Math.round(Math.min(LARGEST, Math.max(SMALLEST, place.clientWidth || LARGEST)));
  const tall = (width) => Math.max(SMALLEST, Math.round(0.66 * width));
  /** Draws again when the width of a place has changed. */
  function fitted(place, draw) {
    let known = wide(place);
    new ResizeObserver(() => {
      if (!place.clientWidth || wide(place) === known) return;
      known = wide(place);
      draw();
    }).observe(place);
  }

  // ---- control chart and nearest fabrics ----------------------------------------------------------------------

  const LEAST_POPULATION = 5; // fabrics behind a mean and SD, as behind a correlation: of n fabrics no |z| is above (n - 1)/√n
  const LEAST_SHARED = 3; // parameters behind a distance

  /** The 16 parameters of the hand equations that occur: mean and SD of the population and z of each fabric. */
  function standardised() {
    const symbols = [...new Set(data.columns.filter((c) => c.log !== null).map((c) => c.symbol))];
    return symbols.map((symbol) => {
      const columns = data.columns.map((c, i) => [c, i]).filter(([c]) => c.symbol === symbol);
      const place = (direction) => columns.find(([c]) => c.direction === direction)?.[1];
      /** What the value of a fabric rests on: both directions, or the fabric as a whole. */
      const grounds = data.fabrics.map((fabric) => {
        const both = ["warp", "weft"].map((direction) => fabric.values[place(direction)]);
        return both.every(Boolean) ? both : [fabric.values[place(null)]].filter(Boolean);
      });
      const given = data.population?.parameters.find((p) => p.symbol === symbol);
      const log = given ? given.log : columns[0][0].log;
      // A mean of two is as certain as the less certain of them.
      const marks = grounds.map((parts) => MARKED[Math.max(...parts.map((part) => MARKED.indexOf(part.status)))]);
      const values = grounds.map((parts) => {
        const value = parts.reduce((sum, part) => sum + part.mean / parts.length, 0);
        if (!parts.length || (log && !(value > 0))) return undefined;
        // In KES units, as the equations take them; the z does not depend on it.
        return log ? Math.log10(value / columns[0][0].factor) : value / columns[0][0].factor;
      });
      const name = (log ? "log " : "") + symbol;
      if (data.population) {
        const z = given ? values.map((v) => (v === undefined ? undefined : (v - given.mean) / given.sd)) : [];
        return { name, n: given?.n, usable: Boolean(given), z, values, marks };
      }
      const known = values.filter((v) => v !== undefined);
      const n = known.length;
      const average = known.reduce((a, b) => a + b, 0) / n;
      const sd = Math.sqrt(known.reduce((a, b) => a + (b - average) ** 2, 0) / (n - 1));
      const usable = n >= LEAST_POPULATION && sd > 1e-9 * Math.abs(average || 1);
      const z = usable ? values.map((v) => (v === undefined ? undefined : (v - average) / sd)) : [];
      return { name, n, usable, z, values, marks };
    });
  }

  /** A point of a chart of fabrics: hollow where its value is less than measured, which its title says as well. */
  function point(attributes, title, mark) {
    const kind = attributes.class + (mark ? " hollow" : "");
    return shape("circle", { ...attributes, class: kind, r: 4 }, shape("title", {}, title + (mark ? `, ${mark}` : "")));
  }
  /** The key of hollow points, where there are any. */
  function hollowKey(some) {
    const sample = shape("svg", { viewBox: "0 0 32 10", "aria-hidden": "true" }, shape("circle", { class: "p0 hollow", cx: 16, cy: 5, r: 4 }));
    return some ? [element("span", {}, sample, " hollow: inferred, assumed or doubtful")] : [];
  }

  /** The other fabrics by the root mean square difference of their standardised parameters. */
  function nearest(parameters, fabric) {
    const found = [];
    data.fabrics.forEach((other, i) => {
      if (i === fabric) return;
      const shared = parameters.filter((p) => p.z[i] !== undefined && p.z[fabric] !== undefined);
      if (shared.length < LEAST_SHARED) return;
      const sum = shared.reduce((a, p) => a + (p.z[i] - p.z[fabric]) ** 2, 0);
      const marked = shared.filter((p) => p.marks[i] || p.marks[fabric]).length;
      found.push({ name: withOrigin(other), distance: Math.sqrt(sum / shared.length), shared: shared.length, marked });
    });
    return found.sort((a, b) => a.distance - b.distance);
  }

  function startControlChart() {
    const place = document.getElementById("control-chart");
    if (!place) return;
    const all = standardised();
    const parameters = all.filter((p) => p.usable);
    const named = (p) => p.name + (p.n === undefined ? "" : ` (n ${p.n})`);
    const unusable = all.filter((p) => !p.usable).map(named).join(", ");
    const source = data.population?.source;
    if (!parameters.length) {
      place.append(element("p", {}, source ? `No parameter of the population (${source}) is known of these fabrics.`
        : `A control chart needs a parameter that ${LEAST_POPULATION} fabrics have.`));
      return;
    }
    const known = (i) => parameters.filter((p) => p.z[i] !== undefined).length;
    const order = data.fabrics.map((_, i) => i).sort((a, b) => known(b) - known(a));
    const selects = [0, 1, 2, 3].map((k) => element("select", { "aria-label": `Fabric ${k + 1}`, change: show },
      element("option", { value: "" }, "–"),
      ...data.fabrics.map((f, i) => element("option", { value: i, selected: k < 2 && order[k] === i }, withOrigin(f)))));
    const chart = element("div", { class: "chart" }), lists = element("div", {});
    place.append(element("p", {}, "The parameters of the hand equations (Kawabata 1980), mean of warp and weft, logarithms where the " +
        "equations take them, as standard deviations from a population. " + populationText(unusable) + " The nearest fabrics are looked for on this page."),
      element("div", { class: "controls" }, ...selects), chart, lists);
    fitted(chart, show);

    function populationText(unusable) {
      if (source) {
        return `The population was given with the run: ${source}; n of each parameter stands beside it where it is known.` +
          (unusable ? ` Left out, as the population lacks them: ${unusable}.` : "");
      }
      const whole = data.fabrics_of_run ? ` of the ${data.fabrics_of_run} of the run` : "";
      return `The population is the fabrics of this page (n = ${data.fabrics.length}${whole}: ${origins()}; n of each parameter stands beside it), ` +
        "no reference of a trade." + (unusable ? ` Left out, with fewer than ${LEAST_POPULATION} different values: ${unusable}.` : "");
    }
    /** How many fabrics have data of which origin: `2 published, 5 synthetic`. */
    function origins() {
      const all = data.fabrics.map((fabric) => fabric.origin || "of unknown origin");
      return [...new Set(all)].sort().map((origin) => `${all.filter((o) => o === origin).length} ${origin}`).join(", ");
    }
    function show() {
      const chosen = selects.map((s) => s.value).map((v, k) => [v, k]).filter(([v]) => v !== "").map(([v, k]) => [Number(v), k]);
      const reach = Math.max(3, ...parameters.flatMap((p) => chosen.map(([i]) => Math.abs(p.z[i] ?? 0)))) + 0.2;
      const width = wide(chart), left = 118, right = 14, step = 26, bottom = 12 + parameters.length * step;
      const x = (z) => left + ((z + reach) / (2 * reach)) * (width - left - right);
      const y = (row) => 12 + (row + 0.5) * step;
      const parts = [];
      for (let z = -Math.floor(reach); z <= reach; z++) {
        parts.push(shape("path", { class: z ? "grid" : "axis", d: `M${x(z)} 8V${bottom}` }),
          shape("text", { x: x(z), y: bottom + 16, "text-anchor": "middle" }, fixed(z, 0)));
      }
      parameters.forEach((p, row) => parts.push(shape("text", { x: left - 8, y: y(row) + 4, "text-anchor": "end" }, named(p))));
      for (const [i, k] of chosen) {
        const points = parameters.map((p, row) => [p.z[i], row, p.marks[i]]).filter(([z]) => z !== undefined).map(([z, row, mark]) => [x(z), y(row), z, mark]);
        parts.push(shape("path", { class: `line p${k} ${["", "second", "third", ""][k]}`, d: "M" + points.map((p) => `${p[0]} ${p[1]}`).join("L") }));
        for (const [px, py, z, mark] of points) {
          parts.push(point({ class: `p${k}`, cx: px, cy: py }, `${withOrigin(data.fabrics[i])}: ${fixed(z, 2)} SD`, mark));
        }
      }
      parts.push(shape("text", { class: "soft", x: (left + width - right) / 2, y: bottom + 34, "text-anchor": "middle" }, source ? `standard deviations from the mean of: ${source}` : "standard deviations from the mean of the population"));
      const names = chosen.map(([i]) => withOrigin(data.fabrics[i])).join(", ");
      const key = ([i, k]) => element("span", {}, shape("svg", { viewBox: "0 0 32 10", "aria-hidden": "true" },
        shape("path", { class: `line p${k} ${["", "second", "third", ""][k]}`, d: "M0 5H32" })), " " + withOrigin(data.fabrics[i]));
      const svg = shape("svg", { viewBox: `0 0 ${width} ${bottom + 42}`, role: "img", "aria-label": `Control chart of ${names}; the values are in the table below` }, ...parts);
      chart.replaceChildren(svg, element("div", { class: "keys" }, ...chosen.map(key), ...hollowKey(parameters.some((p) => chosen.some(([i]) => p.z[i] !== undefined && p.marks[i]))), svgButton(() => svg, () => "control chart")));
      lists.replaceChildren(valueTable(chosen), ...chosen.map(([i]) => nearestText(i)));
    }
    function valueTable(chosen) {
      const row = (p) => element("tr", {}, element("th", { scope: "row" }, p.name),
        ...chosen.map(([i]) => (p.z[i] === undefined ? element("td", { class: "number" }, "–") :
          element("td", { class: `number ${p.marks[i] ?? ""}` }, fixed(p.z[i], 2), ...(p.marks[i] ? [element("small", {}, ` ${p.marks[i]}`)] : [])))));
      const head = ["parameter", ...chosen.map(([i]) => withOrigin(data.fabrics[i]))].map((t) => element("th", { scope: "col" }, t));
      return element("details", {}, element("summary", {}, "Values of the chart"), element("div", { class: "wide", tabindex: "0", role: "region", "aria-label": "Values of the chart" },
        element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...parameters.map(row)))));
    }
    function nearestText(i) {
      const found = nearest(parameters, i).slice(0, 3);
      const list = found.map((f) => `${f.name} (${fixed(f.distance, 2)} SD over ${counted(f.shared, "parameter")}${f.marked ? `, ${f.marked} of them inferred, assumed or doubtful` : ""})`);
      const text = list.length ? list.join("; ") : `none shares ${LEAST_SHARED} parameters with it`;
      return element("p", { class: "nearest" }, element("b", {}, `Nearest to ${withOrigin(data.fabrics[i])}: `), text + ".");
    }
    show();
  }

  if (table) startTable();
  startControlChart();
  window.addEventListener("hashchange", openLinked);
  openLinked();
  return { data, state, table, redraw, followers, fillers, element, shape, checkbox, button, svgButton, counted, breakable, fixed, significant, spread, factor, unit, label,
    columnIsShown, chosenRows, ticks, extent, wide, tall, fitted, standardised, point, hollowKey, withOrigin };
})();
