
// What the page says of each fabric beside its parameters: it follows the filters of the table, and predictions sort.
(() => {
  const { data, followers, element } = report;
  const parts = [...document.querySelectorAll("details.fabric")]; // in the order of the data
  const tables = [...document.querySelectorAll("table.of-fabrics")];
  const known = new Set(data.fabrics.map((fabric) => fabric.name));
  const name = (row) => row.cells[0].textContent;

  followers.push((chosen) => {
    const names = new Set(chosen.map((r) => r.fabric.name));
    parts.forEach((part, i) => { part.hidden = !names.has(data.fabrics[i].name); });
    for (const row of tables.flatMap((table) => [...table.tBodies[0].rows])) row.hidden = known.has(name(row)) && !names.has(name(row));
  });

  /** The number that a cell begins with, its power of ten included. */
  function number(row, column) {
    const text = (row.cells[column]?.textContent ?? "").replaceAll("−", "-");
    const found = /^-?\d[\d.]*(e[-+]?\d+)?/.exec(text);
    return found ? Number(found[0]) : undefined;
  }
  function compare(a, b, column, sign) {
    if (column === 0) return sign * name(a).localeCompare(name(b));
    const [x, y] = [number(a, column), number(b, column)];
    // Fabrics without the value come last either way.
    if (x === undefined || y === undefined) return (x === undefined) - (y === undefined);
    return sign * (x - y);
  }
  /** A click on a heading sorts, largest first; names from the beginning of the alphabet. */
  function sortable(table) {
    const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
    heads.forEach((head, column) => {
      const sort = () => {
        const first = column ? "descending" : "ascending", other = column ? "ascending" : "descending";
        const order = head.getAttribute("aria-sort") === first ? other : first;
        heads.forEach((h) => h.setAttribute("aria-sort", h === head ? order : "none"));
        body.append(...[...body.rows].sort((a, b) => compare(a, b, column, order === "ascending" ? 1 : -1)));
      };
      head.setAttribute("aria-sort", "none");
      head.replaceChildren(element("button", { type: "button", click: sort }, head.textContent));
    });
  }

  tables.filter((table) => !table.classList.contains("stacked") && table.tBodies[0].rows.length > 1).forEach(sortable);
})();
