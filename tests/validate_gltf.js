// SPDX-License-Identifier: MIT
// node validate_gltf.js VALIDATOR FILE...: a line for each error that Khronos' validator finds in a file of glTF; the
// last line is "N errors". VALIDATOR is the folder of the npm package gltf-validator.
const fs = require('fs');
const path = require('path');
const validator = require(path.resolve(process.argv[2], 'index.js'));

async function errorsOf(file) {
  const options = { uri: file, maxIssues: 0, severityOverrides: {} };
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), options);
  return report.issues.messages.filter((issue) => issue.severity === 0);
}

(async () => {
  let count = 0;
  for (const file of process.argv.slice(3)) {
    for (const issue of await errorsOf(file)) {
      console.log(`${file}: ${issue.code} ${issue.pointer || ''}: ${issue.message}`);
      ++count;
    }
  }
  console.log(`${count} errors`);
})().catch((error) => {
  console.log(`not validated: ${error}`);
  process.exit(2);
});
