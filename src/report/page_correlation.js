
// Correlation of parameters over the fabrics of the page: a matrix, and the points behind a pair of it.
(() => {
  const { data, element, shape, svgButton, fixed, ticks, extent, standardised, wide, tall, fitted, point, hollowKey, withOrigin } = report;
  const LEAST = 5; // fabrics behind a coefficient
  const place = document.getElementById("correlation");
  if (!place) return;

  /** Pearson's coefficient of the fabrics that have both, and its 95 % interval (Fisher's z). */
  function correlation(a, b) {
    const both = a.values.map((v, i) => [v, b.values[i], i]).filter(([x, y]) => x !== undefined && y !== undefined);
    const n = both.length;
    const mean = (k) => both.reduce((sum, p) => sum + p[k], 0) / n;
    const [mx, my] = [mean(0), mean(1)];
    const sum = (f) => both.reduce((total, p) => total + f(p[0] - mx, p[1] - my), 0);
    const [xx, yy, xy] = [sum((x) => x * x), sum((_, y) => y * y), sum((x, y) => x * y)];
    const varies = (s, m) => s > 1e-18 * n * Math.max(1, m * m);
    if (n < LEAST || !varies(xx, mx) || !varies(yy, my)) return { n, points: both };
    const r = Math.max(-1, Math.min(1, xy / Math.sqrt(xx * yy)));
    const half = 1.96 / Math.sqrt(n - 3);
    const [low, high] = [Math.tanh(Math.atanh(r) - half), Math.tanh(Math.atanh(r) + half)];
    return { n, r, low, high, points: both, told: low > 0 || high < 0 };
  }

  const parameters = standardised().filter((p) => p.values.filter((v) => v !== undefined).length >= LEAST);
  place.append(element("h3", {}, "Correlation of parameters"));
  if (parameters.length < 2) {
    place.append(element("p", {}, `A correlation needs two parameters that ${LEAST} fabrics have; this page has ${data.fabrics.length} ` +
      `${data.fabrics.length === 1 ? "fabric" : "fabrics"}.`));
    return;
  }
  const pairs = parameters.map((a) => parameters.map((b) => correlation(a, b)));
  const chart = element("div", { class: "chart" });
  const selects = [0, 1].map((k) => element("select", { "aria-label": k ? "Ordinate" : "Abscissa", change: draw },
    ...parameters.map((p, i) => element("option", { value: i }, p.name))));
  const strongest = { value: -1, at: [0, 1] };
  pairs.forEach((row, i) => row.forEach((pair, j) => {
    if (i < j && Math.abs(pair.r ?? 0) > strongest.value) [strongest.value, strongest.at] = [Math.abs(pair.r ?? 0), [i, j]];
  }));
  selects.forEach((select, k) => { select.value = String(strongest.at[k]); });

  function choose(i, j) {
    [selects[0].value, selects[1].value] = [String(j), String(i)];
    draw();
  }
  function cell(i, j) {
    if (i === j) return element("td", {}, "");
    const { r, n, told } = pairs[i][j];
    const names = `${parameters[i].name} and ${parameters[j].name}`;
    if (r === undefined) return element("td", { class: "few", title: `${names}: fewer than ${LEAST} fabrics, or no spread` }, element("small", {}, `n ${n}`));
    const size = Math.abs(r) >= 0.8 ? "strong" : Math.abs(r) >= 0.5 ? "middle" : "weak";
    const button = element("button", { type: "button", "aria-label": `${names}: r ${fixed(r, 2)}, n ${n}`, click: () => choose(i, j) },
      told ? element("b", {}, fixed(r, 2)) : fixed(r, 2));
    return element("td", { class: `${size} ${r < 0 ? "minus" : "plus"}` }, button, element("small", {}, `n ${n}`));
  }
  const head = element("tr", {}, element("td", {}), ...parameters.map((p) => element("th", { scope: "col" }, p.name)));
  const body = parameters.map((p, i) => element("tr", {}, element("th", { scope: "row" }, p.name), ...parameters.map((_, j) => cell(i, j))));
  place.append(
    element("p", {}, "Pearson's r of the same values (mean of warp and weft, logarithms as above) over the fabrics of this page that have " +
      `both; n stands below, and below n = ${LEAST} there is no number. Bold: the 95 % interval (Fisher's z, independent fabrics) ` +
      "leaves out 0. Of many pairs, one in twenty is bold by chance; a correlation is no cause, and these fabrics are no sample of a trade."),
    element("div", { class: "wide", tabindex: "0", role: "region", "aria-label": "Correlation of parameters" },
      element("table", { class: "matrix" }, element("thead", {}, head), element("tbody", {}, ...body))),
    element("div", { class: "controls" }, ...selects), chart);

  function draw() {
    const [i, j] = selects.map((s) => Number(s.value));
    const { r, n, low, high, points } = i === j ? { n: 0, points: [] } : pairs[i][j];
    const told = r === undefined ? `no coefficient (n = ${n})` : `r = ${fixed(r, 2)} (95 % ${fixed(low, 2)} to ${fixed(high, 2)}), n = ${n}`;
    const names = [parameters[i].name, parameters[j].name];
    const caption = element("p", { class: "reading", role: "status" }, i === j ? "Choose two different parameters." : `${names[1]} against ${names[0]}: ${told}`);
    if (i === j || !points.length) { chart.replaceChildren(caption); return; }
    const width = wide(chart), height = tall(width), [left, right, top, bottom] = [66, 12, 10, 46];
    const ranges = [0, 1].map((k) => extent(points.map((p) => p[k])));
    const x = (v) => left + ((v - ranges[0][0]) / (ranges[0][1] - ranges[0][0])) * (width - left - right);
    const y = (v) => height - bottom - ((v - ranges[1][0]) / (ranges[1][1] - ranges[1][0])) * (height - top - bottom);
    const parts = [];
    ranges.forEach((range, k) => {
      const [values, decimals] = ticks(range, 6);
      for (const v of values) parts.push(
        shape("path", { class: "grid", d: k ? `M${left} ${y(v)}H${width - right}` : `M${x(v)} ${top}V${height - bottom}` }),
        shape("text", k ? { x: left - 6, y: y(v) + 4, "text-anchor": "end" } : { x: x(v), y: height - bottom + 16, "text-anchor": "middle" }, fixed(v, decimals)));
    });
    parts.push(shape("rect", { class: "axis", x: left, y: top, width: width - left - right, height: height - top - bottom }),
      shape("text", { class: "soft", x: (left + width - right) / 2, y: height - 8, "text-anchor": "middle" }, names[0]),
      shape("text", { class: "soft", transform: `translate(14 ${(top + height - bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, names[1]));
    let hollow = 0;
    for (const [a, b, fabric] of points) {
      const name = data.fabrics[fabric].name;
      const mark = [i, j].map((k) => parameters[k].marks[fabric] && `${parameters[k].name} ${parameters[k].marks[fabric]}`).filter(Boolean).join(", ");
      if (mark) hollow += 1;
      const end = x(a) > 0.7 * width;
      parts.push(point({ class: "p0", cx: x(a), cy: y(b) }, withOrigin(data.fabrics[fabric]), mark));
      if (points.length <= 30) parts.push(shape("text", { class: "soft", x: x(a) + (end ? -7 : 7), y: y(b) + 4, "text-anchor": end ? "end" : "start" }, name));
    }
    const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${names[1]} against ${names[0]} of ${n} fabrics: ${told}` }, ...parts);
    chart.replaceChildren(svg, caption, element("div", { class: "keys" }, ...hollowKey(hollow), svgButton(() => svg, () => `${names[1]} against ${names[0]}`)));
  }
  draw();
  fitted(chart, draw);
})();
