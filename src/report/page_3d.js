
// Deflected sheets that turn: quads painted from the back to the front on a canvas. Nothing moves by itself.
(() => {
  const { data, element, significant, fillers } = report;
  if (!data.shapes) return;
  // Anchors of viridis (van der Walt & Smith, CC0), as in the charts.
  const COLORS = ["440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725"]
    .map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  const LAMP = [0.25, -0.55, 0.8].map((v) => v / Math.hypot(0.25, 0.55, 0.8));
  const beside = document.querySelector("a[href^='./']") !== null;
  const STEP = Math.PI / 36; // of a key
  const START = { around: -0.9, up: 0.5, zoom: 1.3 };

  function color(t) {
    const place = Math.min(Math.max(t, 0), 1) * (COLORS.length - 1), i = Math.min(Math.floor(place), COLORS.length - 2);
    return [0, 1, 2].map((k) => COLORS[i][k] + (place - i) * (COLORS[i + 1][k] - COLORS[i][k]));
  }
  const bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  function shorts(base64) {
    const view = new DataView(bytes(base64).buffer);
    return Array.from({ length: view.byteLength / 2 }, (_, i) => view.getUint16(2 * i, true));
  }

  /** Of the values at the corners of a quad. */
  function mean(quad, values) {
    return quad.reduce((sum, n) => sum + values[n], 0) / quad.length;
  }

  /** Edges before, nodes, parts of the largest displacement, and quads of a sheet; centred, its largest extent 1. */
  function unpacked(sheet) {
    const [low, high] = sheet.bounds;
    const size = Math.max(...high.map((v, k) => v - low[k])) || 1;
    const numbers = shorts(sheet.places), points = [], quads = [];
    for (let i = 0; i < numbers.length; i += 3) {
      points.push([0, 1, 2].map((k) => ((numbers[i + k] / 65535 - 0.5) * (high[k] - low[k])) / size));
    }
    const corners = shorts(data.shapes.quads[Number(sheet.quads)]);
    // A triangle has one corner twice.
    for (let i = 0; i < corners.length; i += 4) quads.push([...new Set(corners.slice(i, i + 4))]);
    return { before: points.slice(0, sheet.outline), nodes: points.slice(sheet.outline), quads };
  }

  const UNITS = {
    m: [[1e-2, "cm"], [1e-3, "mm"], [1e-6, "µm"], [1e-9, "nm"]],
    N: [[1, "N"], [1e-3, "mN"], [1e-6, "µN"], [1e-9, "nN"]],
  };
  /** A value in the largest of its units that makes it 1 or more. */
  function inWords(value, unit) {
    const all = UNITS[unit] || [[1, unit]], [factor, name] = all.find(([factor]) => value >= factor) || all.at(-1);
    return `${significant(value / factor, 3)} ${name}`;
  }

  class Viewer {
    constructor(sheets, fabric) {
      this.sheets = sheets;
      this.view = { ...START };
      this.before = true;
      this.field = -1;
      this.canvas = element("canvas", { width: 960, height: 640, tabindex: "0", role: "application" });
      this.told = element("p", { class: "reading", role: "status" });
      this.select = element("select", { "aria-label": `Sheet of ${fabric}`, change: () => this.choose() },
        ...sheets.map((sheet, i) => element("option", { value: i }, sheet.title)));
      const button = (text, label, act) => element("button", { type: "button", "aria-label": label, click: () => { act(); this.draw(); } }, text);
      const box = element("input", { type: "checkbox", checked: true, change: () => { this.before = box.checked; this.draw(); } });
      this.fields = element("select", { "aria-label": "Colour", change: () => { this.field = Number(this.fields.value); this.paint(); this.draw(); } });
      this.link = element("a", {}, "");
      this.node = element("div", { class: "chart viewer" },
        element("div", { class: "controls" }, this.select,
          button("◀", "Turn left", () => { this.view.around -= 3 * STEP; }), button("▶", "Turn right", () => { this.view.around += 3 * STEP; }),
          button("▲", "From further above", () => this.tilt(3 * STEP)), button("▼", "From further below", () => this.tilt(-3 * STEP)),
          button("+", "Nearer", () => this.nearer(1.25)), button("−", "Further away", () => this.nearer(0.8)),
          button("Reset", "Reset the view", () => { this.view = { ...START }; }),
          element("label", {}, box, " outline before"), element("label", {}, "Colour: ", this.fields)),
        this.canvas, this.scale(), this.told, element("p", {}, "As a file for Blender or a browser: ", this.link));
      this.listen(fabric);
      this.choose();
    }
    /** The colours with their ends. */
    scale() {
      this.ends = [element("span", {}, "0"), element("span", {}, "")];
      const bar = element("canvas", { width: 256, height: 1, class: "bar", "aria-hidden": "true" });
      const paint = bar.getContext("2d");
      for (let i = 0; i < 256; i++) { paint.fillStyle = `rgb(${color(i / 255).map(Math.round)})`; paint.fillRect(i, 0, 1, 1); }
      return element("div", { class: "keys colors" }, this.ends[0], bar, this.ends[1]);
    }
    choose() {
      const sheet = this.sheets[Number(this.select.value)];
      this.mesh = unpacked(sheet);
      const names = ["length of the displacement", ...(sheet.fields || []).map(({ name }) => name)];
      if (this.field >= names.length - 1) this.field = -1;
      this.fields.replaceChildren(...names.map((name, i) => element("option", { value: i - 1 }, name)));
      this.fields.value = String(this.field);
      this.paint();
      this.link.textContent = sheet.file;
      // A page that was sent has no files beside it.
      if (beside) this.link.setAttribute("href", "./" + sheet.file.split("/").map(encodeURIComponent).join("/"));
      this.draw();
    }
    /** What the colours are, and a part of 255 of the largest for each quad. */
    paint() {
      const sheet = this.sheets[Number(this.select.value)], field = (sheet.fields || [])[this.field];
      const largest = field ? inWords(field.largest, field.unit) : inWords(sheet.largest, "m");
      const values = bytes((field || sheet).values);
      this.mesh.parts = field ? values : this.mesh.quads.map((quad) => mean(quad, values));
      const shown = sheet.scale === 1 ? "shown as it is" : `displacements shown ${significant(sheet.scale, 1)} times as large`;
      const what = field ? `${field.name} of each element` : "length of the displacement";
      this.ends[1].textContent = largest;
      this.told.textContent = `Colour: ${what}, at most ${largest}; ${shown}.`;
      this.canvas.setAttribute("aria-label", `${sheet.title}: ${field ? field.name : "largest displacement"} ${largest}, ${shown}. ` +
        "Arrow keys turn it, plus and minus change the distance, 0 resets.");
    }
    tilt(by) { this.view.up = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.view.up + by)); }
    nearer(by) { this.view.zoom = Math.min(8, Math.max(0.4, this.view.zoom * by)); }
    listen() {
      let from = null;
      this.canvas.addEventListener("pointerdown", (e) => { from = [e.clientX, e.clientY]; this.canvas.setPointerCapture(e.pointerId); });
      this.canvas.addEventListener("pointermove", (e) => {
        if (!from) return;
        this.view.around -= (e.clientX - from[0]) / 150;
        this.tilt((e.clientY - from[1]) / 150);
        from = [e.clientX, e.clientY];
        this.later();
      });
      for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, () => { from = null; });
      this.canvas.addEventListener("keydown", (e) => this.press(e));
      matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    }
    press(event) {
      const act = { ArrowLeft: () => { this.view.around -= STEP; }, ArrowRight: () => { this.view.around += STEP; },
        ArrowUp: () => this.tilt(STEP), ArrowDown: () => this.tilt(-STEP),
        "+": () => this.nearer(1.25), "-": () => this.nearer(0.8), 0: () => { this.view = { ...START }; } }[event.key];
      if (!act) return;
      act();
      event.preventDefault();
      this.later();
    }
    /** Once for each picture of the screen. */
    later() {
      if (this.waiting) return;
      this.waiting = true;
      requestAnimationFrame(() => { this.waiting = false; this.draw(); });
    }
    draw() {
      const { around, up, zoom } = this.view, { nodes, before, parts, quads } = this.mesh;
      const [c, s, cu, su] = [Math.cos(around), Math.sin(around), Math.cos(up), Math.sin(up)];
      const towards = [cu * c, cu * s, su], right = [-s, c, 0], upwards = [-su * c, -su * s, cu];
      const along = (a, p) => a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
      const { width, height } = this.canvas, by = 0.62 * height * zoom;
      const at = (p) => [width / 2 + by * along(right, p), height / 2 - by * along(upwards, p)];
      const paint = this.canvas.getContext("2d");
      paint.clearRect(0, 0, width, height);
      const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink");
      const seen = nodes.map(at), depth = nodes.map((p) => along(towards, p));
      const faces = quads.map((quad, i) => [quad, mean(quad, depth), i]).sort((a, b) => a[1] - b[1]);
      if (this.before) this.outline(paint, before.map(at), ink, 0.55);
      for (const [quad, , face] of faces) {
        const [a, b, d, e = d] = quad.map((n) => nodes[n]);
        const [u, v] = [d.map((x, k) => x - a[k]), e.map((x, k) => x - b[k])];
        const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        const light = 0.62 + 0.38 * Math.abs(along(LAMP, normal)) / (Math.hypot(...normal) || 1);
        paint.fillStyle = paint.strokeStyle = `rgb(${color(parts[face] / 255).map((x) => Math.round(x * light))})`;
        paint.beginPath();
        quad.forEach((n, i) => (i ? paint.lineTo(...seen[n]) : paint.moveTo(...seen[n])));
        paint.closePath();
        paint.fill();
        paint.stroke(); // no gap between neighbours
      }
      // What lies behind the sheet shows through a little.
      if (this.before) this.outline(paint, before.map(at), ink, 0.3);
    }
    outline(paint, places, ink, alpha) {
      paint.save();
      [paint.strokeStyle, paint.globalAlpha, paint.lineWidth] = [ink, alpha, 2];
      paint.beginPath();
      for (let i = 0; i + 1 < places.length; i += 2) { paint.moveTo(...places[i]); paint.lineTo(...places[i + 1]); }
      paint.stroke();
      paint.restore();
    }
  }

  for (const place of document.querySelectorAll(".shapes")) {
    const index = Number(place.dataset.fabric), details = place.closest("details");
    const mine = data.shapes.sheets.filter((sheet) => sheet.fabric === index);
    const fill = () => {
      if (place.childElementCount || !details.open || !mine.length) return;
      place.append(element("h4", {}, "Deflected sheets"), new Viewer(mine, data.fabrics[index].name).node);
    };
    details.addEventListener("toggle", fill);
    fillers.push(fill);
    fill();
  }
})();
