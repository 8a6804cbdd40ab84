// A table of the viewer whose values change: the same texels as read_table makes (tables.js).
class changing_table {
  constructor(cells) {
    this.cells = cells;
    this.numbers = new Int32Array(cells.grid.reduce((a, b) => a * b));
    this.weights = new Float32Array(this.numbers.length);
    const valid = for_each_cell(cells, (cell, number, cosines) => {
      this.numbers[cell] = number;
      this.weights[cell] = Math.max(cosines, 1e-9);
    });
    if (valid !== cells.cells) throw new Error(`${cells.cells} cells of the prior, ${valid} above the horizon`);
    this.texels = new Float32Array(4 * this.numbers.length);
    this.scale = 1;
  }

  // Returns the table in the viewer's form.
  get shown() { return { grid: this.cells.grid, shift: 0.5 - this.cells.offset, scale: 16384 * this.scale, texels: this.texels }; }

  take(values) {
    const largest = values.reduce((most, each) => Math.max(most, each), 1e-9);
    this.scale = 2 ** (Math.ceil(Math.log2(largest)) - 15); // half floats hold up to 65504
    for (let cell = 0; cell < this.numbers.length; ++cell) {
      const weight = this.weights[cell], first = 3 * this.numbers[cell];
      for (let channel = 0; channel < 3; ++channel) this.texels[4 * cell + channel] = values[first + channel] / this.scale * weight;
      this.texels[4 * cell + 3] = 16384 * weight;
    }
  }

  // Replaces the table in a texture of the view: unit 0, or 1 where the truth has its own.
  show_in(view, unit = 0) {
    const { gl } = view, [heights, rows, columns] = this.cells.grid;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, columns, rows, heights, gl.RGBA, gl.FLOAT, this.texels);
    for (const each of view.textures.filter((each) => each.unit === unit)) each.scale = 16384 * this.scale;
  }
}
