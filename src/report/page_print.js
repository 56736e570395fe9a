
// The page on paper, where nothing opens and nothing scrolls.
(() => {
  const { data, table, fillers, element, breakable, spread, factor, unit, label, columnIsShown, chosenRows } = report;
  const ACROSS = 5; // fabrics beside each other on paper

  /** The table of parameters for paper: fabrics are columns, a few at a time, and parameters are rows. */
  function paperTables() {
    const chosen = chosenRows().map((r) => r.fabric), tables = [];
    for (let from = 0; from < chosen.length; from += ACROSS) tables.push(paperTable(chosen.slice(from, from + ACROSS)));
    return element("div", { class: "paper" }, ...tables);
  }
  function paperTable(fabrics) {
    const cell = (column, value) => {
      if (!value) return element("td", {}, "–");
      const by = factor(column), status = value.status === "measured" ? "" : ` · ${value.status}`;
      return element("td", { class: status ? value.status : null }, spread(value.mean / by, value.sd == null ? null : value.sd / by),
        element("small", {}, ` n ${value.n}${status}`));
    };
    const body = data.columns.map((column, i) => [column, i])
      .filter(([column, i]) => columnIsShown(column) && fabrics.some((f) => f.values[i]))
      .map(([column, i]) => element("tr", {}, element("th", { scope: "row" }, label(column), element("small", {}, " " + unit(column))),
        ...fabrics.map((f) => cell(column, f.values[i]))));
    const head = element("tr", {}, element("th", { scope: "col" }, "parameter"), ...fabrics.map((f) => element("th", { scope: "col" }, ...breakable(f.name), element("small", {}, ` ${f.origin}`))));
    return element("table", {}, element("thead", {}, head), element("tbody", {}, ...body));
  }

  /** Everything is open while it is printed, and the table of parameters is turned. */
  function startPrint() {
    let opened = [], paper = null;
    window.addEventListener("beforeprint", () => {
      if (paper) return;
      opened = [...document.querySelectorAll("details:not([open])")];
      for (const details of opened) details.open = true;
      fillers.forEach((fill) => fill()); // an event that a part was opened would come too late
      paper = table ? paperTables() : element("div", {});
      table?.parentElement.after(paper);
      document.documentElement.classList.add("on-paper");
    });
    window.addEventListener("afterprint", () => {
      for (const details of opened) details.open = false;
      paper?.remove();
      [opened, paper] = [[], null];
      document.documentElement.classList.remove("on-paper");
    });
  }

  startPrint();
})();
