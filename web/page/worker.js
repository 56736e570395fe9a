// The thread of the engine: takes files and the form, gives a report of the fabrics alone, which is there at once, then what
// was understood, then everything but drapes, then everything. To cancel, the page ends the thread and begins another.
"use strict";

// Named by the engine: an event of the work.
function tell(kind, text, steps) {
  postMessage({ kind: "event", event: kind, text, steps });
}

const DECODER = new TextDecoder();

async function take({ files, example, loose }) {
  kesf_web.clear();
  for (const { path, file } of files) {
    kesf_web.put(path, new Uint8Array(await file.arrayBuffer()), loose);
  }
  if (example) kesf_web.put_example();
}

// `part` is what of the work is in it: fabrics, cases without drapes, or all.
function report(job, answer, part) {
  const bytes = kesf_web.read("report.html");
  postMessage({ kind: "report", job, said: answer.said, files: answer.files || [], page: DECODER.decode(bytes), part });
}

async function work({ job, form, ...dropped }) {
  await take(dropped);
  const options = JSON.stringify(form);
  const first = JSON.parse(kesf_web.run(options, true, false));
  if ((first.files || []).length) report(job, first, "fabrics");
  const checked = JSON.parse(kesf_web.check(options));
  postMessage({ kind: "checked", job, ...checked });
  const { document } = checked;
  if (document && (document.fabrics.length || document.cases.length)) {
    // Drapes take some ten seconds a fabric: what else there is, is shown before them.
    const hang = form.drape && document.fabrics.some(({ curves }) => curves);
    report(job, JSON.parse(kesf_web.run(options, false, false)), hang ? "cases" : "all");
    if (hang) report(job, JSON.parse(kesf_web.run(options, false, true)), "all");
  }
  postMessage({ kind: "done", job });
}

const ANSWERS = {
  // The first thread unpacks the engine and gives it to the page for those that follow.
  begin({ module, unpack, packed }) {
    if (!module) {
      kesf_web_unpack.initSync({ module: new WebAssembly.Module(unpack) });
      module = new WebAssembly.Module(kesf_web_unpack.unpack(packed));
    }
    kesf_web.initSync({ module });
    postMessage({ kind: "ready", version: kesf_web.version(), module });
  },
  work,
  cards({ form }) {
    const answer = JSON.parse(kesf_web.cards(JSON.stringify(form)));
    postMessage({ kind: "cards", said: answer.said, files: answer.files });
  },
  save({ name, as }) {
    const bytes = name === null ? kesf_web.archive() : kesf_web.read(name);
    postMessage({ kind: "saved", as, bytes }, [bytes.buffer]);
  },
};

// One after the other: reading a file is waited for.
let last = Promise.resolve();
addEventListener("message", ({ data }) => {
  last = last.then(() => ANSWERS[data.ask](data)).catch((error) => {
    postMessage({ kind: "failed", text: String(error && error.message || error) });
  });
});
