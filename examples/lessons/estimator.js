// The estimator of the lesson pages: gonio compiled to WebAssembly (estimator.cpp), and functions that both pages use.

const painted = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));

// Returns a chart's width: at most `most` pixels, and not wider than the page.
const width_of = (most) => Math.min(most, page.clientWidth - 40);

class estimator {
  constructor(calls) { this.calls = calls; }

  // Returns the C string at an address of a module's memory.
  static text(memory, address) {
    const bytes = new Uint8Array(memory.buffer, address);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  // Throws Error if the browser has no WebAssembly or the data are invalid.
  static async start() {
    if (typeof WebAssembly === "undefined") throw new Error("this browser has no WebAssembly");
    const module = Uint8Array.from(atob(data.estimator), (each) => each.charCodeAt(0)), prior = await inflated(data.prior);
    const no_files = Object.fromEntries(["fd_close", "fd_seek", "fd_write"].map((name) => [name, () => 8])); // EBADF
    const refused = (message) => { throw new Error(estimator.text(made.exports.memory, message)); };
    const { instance: made } = await WebAssembly.instantiate(module, { page: { refused }, wasi_snapshot_preview1: no_files });
    made.exports._initialize();
    const started = new estimator(made.exports);
    const buffer = made.exports.buffer_of(Math.ceil(prior.length / 8)); // may move the memory
    new Uint8Array(made.exports.memory.buffer, buffer).set(prior);
    made.exports.take_prior(prior.length);
    return started;
  }

  // Calls a function with numbers in the buffer and returns the numbers that it leaves there.
  ask(name, numbers = [], ...words) {
    this.tell(numbers);
    this.calls[name](...words);
    const size = this.calls.buffer_size(), buffer = this.calls.buffer_of(size);
    return Array.from(new Float64Array(this.calls.memory.buffer, buffer, size));
  }

  tell(numbers) {
    const buffer = this.calls.buffer_of(numbers.length);
    new Float64Array(this.calls.memory.buffer, buffer, numbers.length).set(numbers);
  }

  // Returns reflectance over the prior's valid cells, by a function that finds numbers: red, green, blue. Valid until the next call.
  tabulate(numbers, by = "tabulate", ...words) {
    const { cells } = this.cells();
    this.tell(numbers);
    const values = this.calls[by](...words);
    return new Float32Array(this.calls.memory.buffer, values, 3 * cells);
  }

  cells() {
    const [theta_h, theta_d, phi_d, offset, minimum_cosine, cells] = (this.described ??= this.ask("describe_cells"));
    return { grid: [theta_h, theta_d, phi_d], offset, minimum_cosine, cells };
  }

  // Returns the names of the prior's materials and their weights of the first components: red, then green, then blue.
  materials() {
    const found = [];
    for (let i = 0; this.calls.weights_of(i); ++i)
      found.push({ name: estimator.text(this.calls.memory, this.calls.name_of(i)), weights: this.ask("weights_of", [], i) });
    return found;
  }
}

// Fills the page, or shows why it cannot be filled.
async function open_lesson(title, introduction, fill) {
  const waiting = paragraph("Unpacking 137 materials ...");
  page.append(element("h1", {}, title), ...introduction.map((text) => paragraph(text)), waiting);
  try {
    await painted();
    await fill(await estimator.start());
    waiting.remove();
  } catch (error) {
    waiting.textContent = `Nothing can be computed here: ${error.message}.`;
    waiting.className = "failed";
  }
}
