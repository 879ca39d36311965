// SPDX-License-Identifier: GPL-3.0-or-later
// node gltf_judge.js FILE.glb…: has Khronos' validator (npm gltf-validator) judge files; fails on any error or warning.
const fs = require("fs");
const validator = require("gltf-validator");

(async () => {
    let failed = false;
    for (const file of process.argv.slice(2)) {
        const { issues, info } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
        console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${info.totalTriangleCount} triangles`);
        for (const issue of issues.messages.filter((m) => m.severity < 2)) console.log(`  ${issue.pointer}: ${issue.message}`);
        failed ||= issues.numErrors + issues.numWarnings > 0;
    }
    process.exit(failed ? 1 : 0);
})();
