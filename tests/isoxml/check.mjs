// Makes a layer of which all is known, has it prescribed, and reads TASKDATA as a terminal does.
import { execFileSync } from 'child_process';
import { readFileSync, readdirSync, writeFileSync } from 'fs';
import isoxml from 'isoxml';
import entities from 'isoxml/dist/DDEntities.js';
import JSZip from 'jszip';

const program = process.argv[2];
const fail = (text) => {
  console.error(`check: ${text}`);
  process.exit(1);
};
const near = (what, value, truth, tolerance) => {
  if (!(Math.abs(value - truth) <= tolerance)) fail(`${what} is ${value}, not ${truth}`);
};

// 80 m × 50 m in UTM zone 32N, north of the Alps and west of the zone's middle, where its north is
// not the true one. Stripes of 16 m from west to east: 0, 1, 2, 3, 4; nothing in the south-east.
const [west, south, cell, cols, rows, stripe] = [412000, 5310000, 0.5, 160, 100, 16];
const layerAt = (x, y) => {
  const [east, north] = [x - west, y - south];
  if (east < 0 || north < 0 || east >= cols * cell || north >= rows * cell) return NaN;
  return east > 60 && north < 20 ? NaN : Math.floor(east / stripe);
};
const lines = [`ncols ${cols}`, `nrows ${rows}`, `xllcorner ${west}`, `yllcorner ${south}`,
  `cellsize ${cell}`, 'NODATA_value -9999'];
for (let row = rows - 1; row >= 0; --row) {
  const line = [];
  for (let col = 0; col < cols; ++col) {
    const value = layerAt(west + (col + 0.5) * cell, south + (row + 0.5) * cell);
    line.push(Number.isNaN(value) ? -9999 : value.toFixed(1));
  }
  lines.push(line.join(' '));
}
writeFileSync('layer.asc', lines.join('\n') + '\n');

// Longitude and latitude to UTM, by Krüger's series (Karney 2011, Eq. 35): not by PROJ.
function toUtm32(longitude, latitude) {
  const f = 1 / 298.257223563, n = f / (2 - f), e = Math.sqrt(f * (2 - f));
  const radius = (6378137 / (1 + n)) * (1 + n ** 2 / 4 + n ** 4 / 64);
  const alpha = [n / 2 - (2 / 3) * n ** 2 + (5 / 16) * n ** 3,
    (13 / 48) * n ** 2 - (3 / 5) * n ** 3, (61 / 240) * n ** 3];
  const phi = (latitude * Math.PI) / 180, lambda = ((longitude - 9) * Math.PI) / 180;
  const t = Math.sinh(Math.atanh(Math.sin(phi)) - e * Math.atanh(e * Math.sin(phi)));
  const xi = Math.atan2(t, Math.cos(lambda));
  const eta = Math.atanh(Math.sin(lambda) / Math.sqrt(1 + t * t));
  let [x, y] = [eta, xi];
  alpha.forEach((a, k) => {
    const j = 2 * (k + 1);
    x += a * Math.cos(j * xi) * Math.sinh(j * eta);
    y += a * Math.sin(j * xi) * Math.cosh(j * eta);
  });
  return [500000 + 0.9996 * radius * x, 0.9996 * radius * y];
}

function cellArea(latitude, north, east) {
  const e2 = 6.69437999014e-3, phi = (latitude * Math.PI) / 180;
  const bend = 1 - e2 * Math.sin(phi) ** 2;
  const along = (6378137 * (1 - e2)) / bend ** 1.5, across = 6378137 / Math.sqrt(bend);
  return along * across * Math.cos(phi) * ((Math.PI / 180) ** 2) * north * east;
}

async function read(folder) {
  const zip = new JSZip();
  for (const name of readdirSync(`${folder}/TASKDATA`)) {
    zip.file(`TASKDATA/${name}`, readFileSync(`${folder}/TASKDATA/${name}`));
  }
  const manager = new isoxml.ISOXMLManager();
  await manager.parseISOXMLFile(await zip.generateAsync({ type: 'uint8array' }), 'application/zip');
  // The schema of version 3.3 has no more than these; version 4 asks for nothing beyond.
  if (manager.getWarnings().length) fail(`${folder}: ${manager.getWarnings().join('; ')}`);
  return manager.rootElement.attributes;
}

// Every cell of the grid as [longitude, latitude of its middle, value in steps].
function cellsOf(task) {
  const grid = task.attributes.Grid[0];
  const a = grid.attributes;
  const zones = new Map(task.attributes.TreatmentZone.map((zone) =>
    [zone.attributes.TreatmentZoneCode, zone.attributes.ProcessDataVariable[0].attributes]));
  const view = new DataView(grid.binaryData.buffer, grid.binaryData.byteOffset);
  if (a.Filelength !== grid.binaryData.length) fail('the length of the grid file is another');
  const cells = [];
  for (let row = 0; row < a.GridMaximumRow; ++row) {
    for (let col = 0; col < a.GridMaximumColumn; ++col) {
      const at = row * a.GridMaximumColumn + col;
      cells.push([a.GridMinimumEastPosition + (col + 0.5) * a.GridCellEastSize,
        a.GridMinimumNorthPosition + (row + 0.5) * a.GridCellNorthSize,
        a.GridType === '1' ? zones.get(view.getUint8(at)).ProcessDataValue
          : view.getInt32(4 * at, true)]);
    }
  }
  return { cells, zones, attributes: a };
}

// Rates by class of the layer: below 1, 1 to 3, from 3.
const cases = [
  { name: 'litres', unit: 'L/ha', rates: [200, 150.5, 0], ddi: 1, perUnit: 100, more: [] },
  { name: 'kilograms', unit: 'kg/ha', rates: [80, 120, 160], ddi: 6, perUnit: 100,
    more: ['--isoxml-grid', '2'] },
  { name: 'seeds', unit: 'seeds/m2', rates: [9.5, 8, 7.25], ddi: 11, perUnit: 1,
    more: ['--width', '2', '--length', '4'] },
  { name: 'turned', unit: 'lb/ac', rates: [100, 50, 25], ddi: 6, perUnit: 112.0851,
    more: ['--heading', '30', '--isoxml-grid', '2'] },
];
for (const { name, unit, rates, ddi, perUnit, more } of cases) {
  const length = more.includes('--length') ? 4 : 3;
  execFileSync(program, ['prescribe', 'layer.asc', '--crs', 'EPSG:32632', '--breaks', '1,3',
    '--rates', rates.join(','), '--unit', unit, '--product', 'Mittel & Co', '-o', name,
    '--overwrite', '--no-pictures', '--quiet', ...more]);
  const root = await read(name);
  const task = root.Task[0];
  const { cells, attributes } = cellsOf(task);
  const described = task.getGridValuesDescription()[0];
  if (described.DDINumber !== ddi || described.unit !== unit) {
    fail(`${name}: is of DDI ${described.DDINumber} in ${described.unit}`);
  }
  if (root.Product[0].attributes.ProductDesignator !== 'Mittel & Co') fail(`${name}: product`);
  const resolution = entities.default[ddi].bitResolution;
  let compared = 0;
  let amount = 0;
  // A square reaches so far from the middle of any of its cells.
  const reach = name === 'turned' ? Math.SQRT2 * length + 0.1 : 0.75 * length;
  for (const [longitude, latitude, value] of cells) {
    const [x, y] = toUtm32(longitude, latitude);
    const rate = (value * resolution) / perUnit;  // by the dictionary
    near(`${name}: a rate as it is shown`, (value + described.offset) * described.scale, rate,
      1e-4 * Math.max(1, rate));
    amount += rate * cellArea(latitude, attributes.GridCellNorthSize, attributes.GridCellEastSize);
    // Squares that lie within one stripe, or beyond the layer, have its rate; others some mean's.
    const around = [];
    for (const dx of [-reach, 0, reach]) {
      for (const dy of [-reach, 0, reach]) around.push(layerAt(x + dx, y + dy));
    }
    if (!around.every((v) => Object.is(v, around[0]))) continue;
    const layer = around[0];
    const truth = Number.isNaN(layer) ? 0 : rates[layer < 1 ? 0 : layer < 3 ? 1 : 2];
    near(`${name}: the rate at ${x}, ${y}`, rate, truth, 1e-3 * truth);
    ++compared;
  }
  if (compared < 0.4 * cells.length) fail(`${name}: only ${compared} cells could be compared`);
  const json = JSON.parse(readFileSync(`${name}/prescription.json`));
  const perArea = unit.endsWith('/ha') ? 1e4 : unit.endsWith('/ac') ? 4046.8564224 : 1;
  near(`${name}: the amount`, json.isoxml_grid.amount, amount / perArea, 1e-4 * json.total.amount);
  near(`${name}: the amount of all`, json.total.amount, json.isoxml_grid.amount,
    (name === 'turned' ? 0.01 : 1e-9) * json.total.amount);
  console.log(`${name}: ${compared} of ${cells.length} cells of type ${attributes.GridType} have ` +
    `the rate of the layer under them`);
}
