
// Curves of tests: recorded loops, windows of the fits, simulated curves; read by pointer, finger and keys.
(() => {
  const { data, state, redraw, fillers, element, shape, checkbox, button, svgButton, counted, fixed, significant, factor, unit, label, ticks, extent, wide, tall, fitted } = report;
  const FRAME = { left: 66, right: 12, top: 10, bottom: 46 };

  /** 1, 2 and 5 times powers of ten in a range of positive numbers. */
  function decades([low, high]) {
    const all = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++) for (const d of [1, 2, 5]) all.push(d * 10 ** e);
    return all.filter((v) => v >= low && v <= high);
  }

  /** A chart of one test: recorded loops, windows of the fits, simulated curves; hover, zoom, switches. */
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
      this.fabric = fabric;
      this.svg = shape("svg", { role: "application", tabindex: "0" });
      this.reading = element("div", { class: "reading", role: "status" });
      this.at = 0; // the point that the keyboard reads
      this.listen();
      const keys = element("div", { class: "keys" }, ...this.traces.map((t) => this.key(t)));
      this.windows = true;
      if (curves.specimens.some((s) => s.windows.length)) {
        keys.append(checkbox("windows of the fits", true, (on) => { this.windows = on; this.draw(); }));
      }
      this.log = false;
      if (curves.test === "compression") {
        keys.append(checkbox("logarithmic pressure", false, (on) => { this.log = on; this.reset(); }));
      }
      const remark = curves.specimens.length ? "" : " (no curve recorded, simulated only)";
      this.node = element("div", { class: "chart" },
        element("h4", {}, curves.test + remark),
        element("div", { class: "zoom", role: "group", "aria-label": "Zoom" }, button("+", "Zoom in", () => this.nearer(0.25)),
          button("−", "Zoom out", () => this.nearer(-0.5)), button("Reset", "Reset the zoom", () => this.reset()), svgButton(() => this.svg, () => `${fabric.name} ${curves.test}`)),
        this.svg, this.reading, keys);
      redraw.push(() => this.draw());
      fitted(this.node, () => this.draw());
      this.draw();
    }
    /** What is seen, for readers who do not see it: axes, ranges, how many curves, and the values read from them. */
    told(ranges, axes) {
      const { test, specimens, simulated } = this.curves;
      const directions = [...new Set(specimens.map((s) => s.direction).filter(Boolean))].join(" and ");
      const range = ([low, high], a) => `${significant(low / a.by, 3)} to ${significant(high / a.by, 3)}${a.unit ? " " + a.unit : ""}`;
      const values = data.columns.flatMap((column, i) => {
        const value = column.test === test ? this.fabric.values[i] : undefined;
        return value ? [`${label(column)} ${significant(value.mean / factor(column), 3)}${unit(column) ? " " + unit(column) : ""}`] : [];
      });
      return `${test} of ${this.fabric.name}${directions ? ", " + directions : ""}: ${axes[1].quantity} against ${axes[0].quantity}, ` +
        `${range(ranges[0], axes[0])} and ${range(ranges[1], axes[1])}; ${counted(specimens.length, `${this.fabric.origin || "recorded"} specimen`)}, ` +
        `${counted(simulated.length, "simulated curve")}${values.length ? "; " + values.join(", ") : ""}. ` +
        "Arrow keys read values, plus and minus zoom, 0 resets.";
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
      return { class: `curve ${trace.direction ?? "none"}${kind}` };
    }
    get axes() { return this.curves.axes.map((a) => ({ quantity: a.quantity, unit: (state.si ? a.si : a.kes)[0], by: (state.si ? a.si : a.kes)[1] })); }
    /** Ranges in SI: those of everything that is switched on, or the zoom. */
    ranges() {
      if (this.zoom) return this.zoom;
      const on = this.traces.filter((t) => t.on).flatMap((t) => t.lines);
      if (!on.length) return [[0, 1], [0, 1]];
      const heights = on.flatMap((l) => l.y), positive = heights.filter((y) => y > 0);
      if (!this.log || !positive.length) return [extent(on.flatMap((l) => l.x)), extent(heights)];
      const largest = positive.reduce((a, b) => Math.max(a, b));
      return [extent(on.flatMap((l) => l.x)), [Math.max(positive.reduce((a, b) => Math.min(a, b)), largest / 1e3) / 1.1, 1.1 * largest]];
    }
    /** To and from what the ordinate is even in. What a logarithm has no place for lies below. */
    get even() { return this.log ? [(v) => Math.log10(Math.max(v, 1e-300)), (v) => 10 ** v] : [(v) => v, (v) => v]; }
    place([rx, ry]) {
      const [to, from] = this.even, [low, high] = ry.map(to);
      const w = this.width - FRAME.left - FRAME.right, h = this.height - FRAME.top - FRAME.bottom;
      return {
        x: (v) => FRAME.left + ((v - rx[0]) / (rx[1] - rx[0])) * w,
        y: (v) => FRAME.top + h - Math.max(-1, (to(v) - low) / (high - low)) * h,
        backX: (p) => rx[0] + ((p - FRAME.left) / w) * (rx[1] - rx[0]),
        backY: (p) => from(low + ((FRAME.top + h - p) / h) * (high - low)),
      };
    }
    draw() {
      this.width = wide(this.node);
      this.height = tall(this.width);
      const ranges = this.ranges(), at = this.place(ranges), axes = this.axes;
      const [width, height] = [this.width - FRAME.left - FRAME.right, this.height - FRAME.top - FRAME.bottom];
      this.scale = at;
      this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
      this.svg.setAttribute("aria-label", this.told(ranges, axes));
      const parts = [this.frame(ranges, at, axes)];
      const inside = shape("svg", { x: FRAME.left, y: FRAME.top, width, height, viewBox: `${FRAME.left} ${FRAME.top} ${width} ${height}` });
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
      const height = this.height - FRAME.top - FRAME.bottom;
      return [...bands.values()].map(([symbol, left, right]) => shape("rect",
        { class: "window", x: left, y: FRAME.top, width: right - left, height }, shape("title", {}, `window of ${symbol}`)));
    }
    frame(ranges, at, axes) {
      const group = shape("g", {});
      const [right, bottom] = [this.width - FRAME.right, this.height - FRAME.bottom];
      ranges.forEach((range, i) => {
        const by = axes[i].by;
        const shown = [range[0] / by, range[1] / by];
        const [values, decimals] = i && this.log ? [decades(shown)] : ticks(shown, i ? 6 : Math.round(this.width / 90));
        for (const v of values) {
          const p = i ? at.y(v * by) : at.x(v * by);
          group.append(shape("path", { class: "grid", d: i ? `M${FRAME.left} ${p}H${right}` : `M${p} ${FRAME.top}V${bottom}` }),
            shape("text", i ? { x: FRAME.left - 6, y: p + 4, "text-anchor": "end" } : { x: p, y: bottom + 16, "text-anchor": "middle" },
              decimals === undefined ? significant(v, 1) : fixed(v, decimals)));
        }
      });
      const named = (a) => a.quantity + (a.unit ? ` (${a.unit})` : "");
      group.append(shape("rect", { class: "axis", x: FRAME.left, y: FRAME.top, width: right - FRAME.left, height: bottom - FRAME.top }),
        shape("text", { class: "soft", x: (FRAME.left + right) / 2, y: this.height - 8, "text-anchor": "middle" }, named(axes[0])),
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
      return [(event.clientX - box.left) * (this.width / box.width), (event.clientY - box.top) * (this.height / box.height)];
    }
    /** Reads the point that is nearest, within a reach. */
    hover([px, py], reach = 30) {
      let best = null, distance = reach ** 2;
      for (const point of this.points()) {
        const d = (this.scale.x(point[1]) - px) ** 2 + (this.scale.y(point[2]) - py) ** 2;
        if (d < distance) [best, distance] = [point, d];
      }
      if (best) this.read(best);
    }
    listen() {
      let start = null;
      this.svg.addEventListener("pointerdown", (e) => {
        // A finger reads where it is set down, however far the curve is; dragging it scrolls the page.
        if (e.pointerType === "touch") return this.hover(this.pointer(e), Infinity);
        if (e.button !== 0) return;
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
      this.svg.addEventListener("dblclick", () => this.reset());
      this.svg.addEventListener("keydown", (e) => this.press(e));
    }
    /** A part of the range is cut off at each end; of a negative one it is added. */
    nearer(by) {
      const [to, from] = this.even;
      const cut = ([a, b]) => [a + by * (b - a), b - by * (b - a)];
      this.zoom = this.ranges().map((range, i) => (i ? cut(range.map(to)).map(from) : cut(range)));
      this.draw();
    }
    reset() {
      this.zoom = null;
      this.draw();
    }
    press(event) {
      const step = { ArrowRight: 1, ArrowLeft: -1, ArrowUp: 10, ArrowDown: -10 }[event.key];
      const points = this.points();
      if (step && points.length) {
        this.at = (this.at + step + points.length) % points.length;
        this.read(points[this.at]);
      } else if (event.key === "0") this.reset();
      else if (event.key === "+") this.nearer(0.25);
      else if (event.key === "-") this.nearer(-0.5);
      else return;
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
        place.append(element("p", {}, "Drag to zoom, double click to reset, or use the buttons; the nearest point is read below the chart. Dashed and thick: simulated."),
          element("div", { class: "charts" }, ...mine.map((c) => new Chart(c, data.fabrics[index]).node)));
      };
      place.closest("details").addEventListener("toggle", fill);
      fillers.push(fill);
      fill();
    }
  }

  startCurves();
})();
