
// Reads light probes: Radiance images (.hdr), whose pixels have a shared exponent in the fourth byte.

const most_hdr_pixels = 2 ** 23;

// Returns the rows and columns that the header states, and the position of the first pixel. Ignores EXPOSURE: the viewer
// chooses its own exposure.
function read_hdr_header(bytes) {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, 4096));
  const found = /^#\?[^]*?\n\n-Y (\d{1,5}) \+X (\d{1,5})\n/.exec(text);
  if (!found) throw new Error("it does not begin as a Radiance picture, from top to bottom");
  const colour = /^(FORMAT=32-bit_rle_xyze|COLORCORR=.*|PRIMARIES=.*[1-9].*)$/m.exec(found[0]);
  if (colour) throw new Error(`its header says ${colour[1]}: expected RGB in the standard primaries`);
  const rows = Number(found[1]), columns = Number(found[2]);
  if (columns !== 2 * rows || rows < 1) throw new Error(`${columns} x ${rows} pixels are not twice as wide as high`);
  if (rows * columns > most_hdr_pixels) throw new Error(`more than ${most_hdr_pixels} pixels`);
  return { rows, columns, start: found[0].length };
}

// Returns the four bytes of each pixel. The file packs them row by row, or not at all.
function unpacked_hdr(bytes, { rows, columns, start }) {
  const rgbe = new Uint8Array(4 * rows * columns);
  let at = start;
  const next = () => {
    if (at >= bytes.length) throw new Error("the file ends before its last pixel");
    return bytes[at++];
  };
  const is_packed = bytes[at] === 2 && bytes[at + 1] === 2 && (bytes[at + 2] << 8 | bytes[at + 3]) === columns;
  if (!is_packed) return rgbe.map(next);
  for (let row = 0; row < rows; ++row) {
    const head = [next(), next(), next(), next()];
    if (head[0] !== 2 || head[1] !== 2 || (head[2] << 8 | head[3]) !== columns) throw new Error(`row ${row + 1} has no beginning`);
    for (let channel = 0; channel < 4; ++channel)
      for (let column = 0; column < columns;) {
        const code = next(), is_run = code > 128, count = is_run ? code - 128 : code, value = is_run ? next() : 0;
        if (count === 0 || column + count > columns) throw new Error(`row ${row + 1} is longer than the picture`);
        for (let i = 0; i < count; ++i) rgbe[4 * (row * columns + column++) + channel] = is_run ? value : next();
      }
  }
  return rgbe;
}

// Returns radiance, three numbers per pixel from the top left on. Throws Error if the bytes are no light probe.
function read_hdr(bytes) {
  const header = read_hdr_header(bytes), rgbe = unpacked_hdr(bytes, header);
  const radiance = new Float32Array(3 * header.rows * header.columns);
  for (let i = 0; i < radiance.length; ++i) {
    const pixel = Math.floor(i / 3), exponent = rgbe[4 * pixel + 3];
    radiance[i] = exponent ? rgbe[4 * pixel + i % 3] * 2 ** (exponent - 136) : 0;
  }
  if (!radiance.some((each) => each > 0)) throw new Error("all of it is black");
  return { rows: header.rows, columns: header.columns, radiance };
}
