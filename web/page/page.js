// The page that is dropped on: keeps what was dropped, asks the worker, and shows what it answers. Every text of a file goes
// into the page as text, never as markup.
(() => {
  "use strict";

  const place = (id) => document.getElementById(id);
  const element = (name, attributes = {}, ...inside) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key === "onclick") made.addEventListener("click", value);
      else made.setAttribute(key, value);
    }
    made.append(...inside);
    return made;
  };

  // Larger files are the command's: WebAssembly has 4 GB for a file, its copy and everything else.
  const LARGEST = 500e6;
  const WAIT = 500;
  // Milliseconds after the last sign of a drag: it is over, or has left the window.
  const DRAG = 1000;
  const state = { dropped: [], refused: [], example: false, worker: null, engine: null, module: null, job: 0, busy: false, steps: 0, files: [], page: "", frame: null };

  const bytes = (id) => Uint8Array.from(atob(place(id).textContent.trim()), (c) => c.charCodeAt(0));

  // The engine as it is in the page, and what unpacks it, for the first thread.
  async function engine() {
    const stream = new Blob([bytes("unpack")]).stream().pipeThrough(new DecompressionStream("gzip"));
    return { unpack: await new Response(stream).arrayBuffer(), packed: bytes("engine") };
  }

  function begin() {
    if (state.worker) state.worker.terminate();
    lost();
    const text = new Blob([place("worker-text").textContent], { type: "text/javascript" });
    const address = URL.createObjectURL(text);
    const worker = new Worker(address);
    state.worker = worker;
    // What a thread had said before it was ended counts no more.
    worker.addEventListener("message", ({ data }) => { if (worker === state.worker) ANSWERS[data.kind](data); });
    worker.addEventListener("error", (event) => { if (worker === state.worker) broken(event.message); });
    worker.postMessage({ ask: "begin", module: state.module, ...(state.module ? {} : state.engine) });
  }

  // The results are in the memory of the thread.
  function lost() {
    downloads([]);
    for (const id of ["save-all", "make-cards"]) place(id).disabled = true;
  }

  const form = () => ({
    settings: place("settings").value,
    dialect: place("dialect").value,
    assume_kes_units: place("kes-units").checked,
    cases: place("cases").checked,
    drape: place("drape").checked,
  });

  const loose = () => place("loose").value.trim().replace(/[/\\]/g, "-") || "dropped";

  // Everything anew, from the files: a job that goes on is ended.
  function work() {
    if (!state.worker || !(state.dropped.length || state.example)) return;
    if (state.busy) begin();
    lost();
    state.job += 1;
    busy(true);
    say("Reading.");
    place("forget").hidden = false;
    performance.mark("kesf-asked");
    state.worker.postMessage({
      ask: "work", job: state.job, files: state.dropped, example: state.example, loose: loose(), form: form(),
    });
  }

  function busy(is) {
    // How often work has ended, for whoever waits for it.
    if (state.busy && !is) document.body.dataset.ended = Number(document.body.dataset.ended || 0) + 1;
    state.busy = is;
    place("working").hidden = !is;
    place("progress").removeAttribute("value");
    document.body.toggleAttribute("data-busy", is);
  }

  const say = (text) => { place("status").textContent = text; };

  function cancel() {
    begin();
    busy(false);
    say("Cancelled. The files are still here: change something above, or drop more, to begin again.");
  }

  // A defect of the engine, or of the memory that a browser gives: the thread is gone, the page goes on.
  function broken(text) {
    begin();
    busy(false);
    say(`The work ended with a defect: ${text || "no memory, or an error without a text"}. The page goes on without these results; the command \`kesf run\` may do what the page cannot.`);
  }

  const ANSWERS = {
    ready({ version, module }) {
      state.module = module;
      place("about").textContent = `kesf ${version}. Drapes are quick ones here, and pictures need fonts: the whole of a drape, pictures and results to be resumed are the command's.`;
      document.body.dataset.ready = "";
    },
    event({ event, text, steps }) {
      const bar = place("progress");
      if (event === "started") {
        state.steps = 0;
        bar.removeAttribute("value");
        if (steps) [bar.max, bar.value] = [steps, 0];
        const what = text.charAt(0).toUpperCase() + text.slice(1);
        say(steps ? `${what}: ${steps} to do.` : `${what}.`);
      } else if (event === "step") {
        state.steps += 1;
        bar.value = state.steps;
      } else if (event === "defect") {
        broken(text);
      }
    },
    checked(answer) { if (answer.job === state.job) understood(answer); },
    report(answer) { if (answer.job === state.job) results(answer); },
    done({ job }) {
      if (job !== state.job) return;
      busy(false);
      const { fabrics, cases, errors } = state.count || { fabrics: 0, cases: 0, errors: 1 };
      const plural = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
      say(`Done: ${plural(fabrics, "fabric")}${cases ? `, ${plural(cases, "case")} of your own` : ""}, ${plural(errors, "error")}.`);
    },
    cards({ said, files }) {
      busy(false);
      say(`Done: ${files.filter((f) => f.name.startsWith("cards/")).length} material cards, ${said.length} messages.`);
      place("stage").replaceChildren(...messages(said));
      downloads(files);
    },
    saved({ as, bytes }) { save(as, bytes); },
    failed({ text }) { broken(text); },
  };

  const WORDS = { error: "Error", finding: "Finding", note: "Note" };

  function messages(lines) {
    if (!lines.length) return [];
    return [element("ul", { class: "messages" }, ...lines.map(({ kind, text }) =>
      element("li", { class: kind }, element("span", { class: "word" }, `${WORDS[kind]}: `), text)))];
  }

  // What `kesf check -v` says, by fabric and file.
  function understood({ document: checked, said, passed_by: passedBy }) {
    performance.mark("kesf-understood");
    place("understood").hidden = false;
    const fabrics = checked ? checked.fabrics : [];
    const errors = said.filter((line) => line.kind === "error");
    state.count = { fabrics: fabrics.length, cases: checked ? checked.cases.length : 0, errors: errors.length + state.refused.length };
    const inFabric = new Set(fabrics.flatMap((fabric) => fabric.files.map((file) => file.path)));
    const general = said.filter((line) => line.kind === "error" || !inFabric.has(line.file));
    const passed = (passedBy || []).length
      ? [element("p", { class: "soft" }, `Passed by, as files that are named like no measurement: ${passedBy.join(", ")}.`)] : [];
    place("messages").replaceChildren(...messages([...state.refused.map((text) => ({ kind: "error", text })), ...general]), ...passed);
    const how = new Map((checked ? checked.inference : []).map(({ path, decisions }) => [path, decisions]));
    const unread = [...how.keys()].filter((path) => !inFabric.has(path));
    place("fabrics").replaceChildren(
      ...fabrics.map((fabric) => ofFabric(fabric, how, said)),
      ...unread.map((path) => element("details", { class: "fabric" },
        element("summary", {}, element("strong", {}, path), " was not read: what had been inferred"), decisions(how.get(path)))),
    );
    if (!(fabrics.length || (checked && checked.cases.length))) place("results").hidden = true;
  }

  const decisions = (list) => element("ul", { class: "how" }, ...(list || []).map((text) => element("li", {}, text)));

  function ofFabric(fabric, how, said) {
    const counts = [[fabric.files.length, "files"], [fabric.curves, "curves"], [fabric.values, "values of tables"], [fabric.findings.length, "findings"]];
    const told = counts.filter(([n]) => n).map(([n, what]) => `${n} ${n === 1 ? what.replace(/s( of|$)/, "$1") : what}`).join(", ");
    return element("details", { class: "fabric" },
      element("summary", {}, element("strong", {}, fabric.name), ` ${told}`),
      ...fabric.files.flatMap((file) => {
        const own = said.filter((line) => line.file === file.path && line.kind !== "error");
        return [element("p", { class: "file" }, element("code", {}, file.path)), decisions(how.get(file.path)), ...messages(own)];
      }));
  }

  const TO_COME = {
    fabrics: "Parameters and curves; the simulations are on their way.",
    cases: "Everything but drapes, which are on their way: some ten seconds or more for each fabric with curves.",
    all: "",
  };

  function results({ said, files, page, part }) {
    const isFinal = part === "all";
    performance.mark({ fabrics: "kesf-fabrics", cases: "kesf-cases", all: "kesf-report" }[part]);
    if (!page) {
      if (isFinal) place("messages").append(...messages(said));
      return;
    }
    place("results").hidden = false;
    state.page = page;
    place("stage").textContent = TO_COME[part];
    if (isFinal) place("stage").replaceChildren(...failed(said));
    show(page);
    downloads(isFinal ? files : []);
    for (const id of ["save-all", "make-cards"]) place(id).disabled = !isFinal;
  }

  // Errors of the run that reading had not met.
  function failed(said) {
    const known = place("messages").textContent;
    return messages(said.filter((line) => line.kind === "error" && !known.includes(line.text)));
  }

  // The report as it is, in a frame of its own without the rights of this page: a browser makes a process for it, which
  // is begun with an empty page.
  function show(page) {
    if (state.frame) URL.revokeObjectURL(state.frame);
    state.frame = URL.createObjectURL(new Blob([page], { type: "text/html" }));
    place("report").src = state.frame;
  }

  function size(bytes) {
    const [value, unit] = bytes < 1e4 ? [bytes, "bytes"] : bytes < 1e6 ? [bytes / 1e3, "kB"] : [bytes / 1e6, "MB"];
    return `${value >= 100 ? Math.round(value) : value.toPrecision(2)} ${unit}`;
  }

  // By folder: tables of all fabrics first.
  function downloads(files) {
    state.files = files;
    const groups = new Map();
    for (const file of files) {
      const at = file.name.lastIndexOf("/");
      const folder = at < 0 ? "" : file.name.slice(0, at);
      groups.set(folder, [...(groups.get(folder) || []), { ...file, short: file.name.slice(at + 1) }]);
    }
    const list = (group) => element("ul", {}, ...group.map(({ name, short, bytes }) => element("li", {},
      element("button", { type: "button", "data-file": name, onclick: () => ask(name, short) }, short), ` ${size(bytes)}`)));
    const folders = [...groups.keys()].filter((folder) => folder).sort();
    place("downloads").replaceChildren(
      ...(groups.has("") ? [list(groups.get(""))] : []),
      ...folders.map((folder) => element("details", {},
        element("summary", {}, `${folder}: ${groups.get(folder).length} files`), list(groups.get(folder)))),
    );
  }

  const ask = (name, as) => state.worker.postMessage({ ask: "save", name, as });

  function save(name, bytes) {
    const address = URL.createObjectURL(new Blob([bytes], { type: "application/octet-stream" }));
    element("a", { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
  }

  function add(files) {
    const tooLarge = files.filter(({ file }) => file.size > LARGEST);
    const taken = files.filter((entry) => !tooLarge.includes(entry));
    const known = new Map(state.dropped.map((entry) => [entry.path, entry]));
    for (const entry of taken) known.set(entry.path, entry);
    state.dropped = [...known.values()];
    // Kept, because the work on the other files says things of its own.
    const refused = tooLarge.map(({ path }) => `${path}: the page takes files of up to ${size(LARGEST)}; give it to the command.`);
    state.refused.push(...refused.filter((text) => !state.refused.includes(text)));
    // The example is to be looked at by itself.
    if (taken.length) state.example = false;
    work();
    if (refused.length && !taken.length) say(refused.join(" "));
  }

  // Folders of a drop, file by file; a browser gives at most 100 entries at a time.
  async function below(entry) {
    if (entry.isFile) {
      const file = await new Promise((resolve, reject) => { entry.file(resolve, reject); });
      return [{ path: entry.fullPath.replace(/^\//, ""), file }];
    }
    const reader = entry.createReader();
    const entries = [];
    for (;;) {
      const some = await new Promise((resolve, reject) => { reader.readEntries(resolve, reject); });
      if (!some.length) break;
      entries.push(...some);
    }
    return (await Promise.all(entries.map(below))).flat();
  }

  async function dropped(transfer) {
    performance.mark("kesf-dropped");
    // The browser empties the transfer once the event is over.
    const files = [...transfer.files].map((file) => ({ path: file.name, file }));
    const entries = [...transfer.items].map((item) => item.webkitGetAsEntry && item.webkitGetAsEntry());
    if (entries.length && entries.every(Boolean)) {
      try {
        return add((await Promise.all(entries.map(below))).flat());
      } catch (error) {
        // A page from a disk may not look into folders in some browsers; files come as they are.
        if (entries.some((entry) => entry.isDirectory)) {
          return say(`The browser does not let the page look into the folder (${error.name}); use "Choose a folder", or drop the files.`);
        }
      }
    }
    add(files);
  }

  function forget() {
    if (state.busy) begin();
    busy(false);
    Object.assign(state, { dropped: [], refused: [], example: false, job: state.job + 1, count: null });
    for (const id of ["understood", "results", "forget"]) place(id).hidden = true;
    say("");
  }

  function listen() {
    const zone = document.documentElement;
    const over = (is) => (event) => {
      event.preventDefault();
      place("drop").classList.toggle("over", is);
    };
    // The frame of the report would take a drag for itself, and nobody would hear of it.
    let last = 0;
    const dragged = () => {
      document.body.classList.add("dragged");
      clearTimeout(last);
      last = setTimeout(() => document.body.classList.remove("dragged"), DRAG);
    };
    for (const kind of ["dragenter", "dragover"]) zone.addEventListener(kind, dragged);
    zone.addEventListener("dragover", over(true));
    zone.addEventListener("dragleave", over(false));
    zone.addEventListener("drop", (event) => {
      over(false)(event);
      document.body.classList.remove("dragged");
      dropped(event.dataTransfer);
    });
    for (const [button, input] of [["pick-files", "files"], ["pick-folder", "folder"]]) {
      place(button).addEventListener("click", () => place(input).click());
      place(input).addEventListener("change", ({ target }) => {
        performance.mark("kesf-dropped");
        add([...target.files].map((file) => ({ path: file.webkitRelativePath || file.name, file })));
        target.value = "";
      });
    }
    place("example").addEventListener("click", () => { state.example = true; work(); });
    place("forget").addEventListener("click", forget);
    place("cancel").addEventListener("click", cancel);
    place("save-all").addEventListener("click", () => ask(null, "kesf-results.zip"));
    place("save-report").addEventListener("click", () => save("report.html", state.page));
    place("make-cards").addEventListener("click", () => {
      busy(true);
      say("Making material cards.");
      state.worker.postMessage({ ask: "cards", form: form() });
    });
    let timer = 0;
    place("form").addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(work, WAIT);
    });
  }

  async function start() {
    listen();
    show("<!DOCTYPE html><html lang=\"en\"><title>Report</title></html>");
    try {
      state.engine = await engine();
    } catch (error) {
      return say(`This browser cannot run the engine (${error.message}). Firefox 113, Chrome 90, Edge 90, Safari 16.4 and later can.`);
    }
    begin();
    work();
  }

  start();
})();
