// Prints "errors warnings" as the Khronos validator counts them, then each message.
// Exits with 3 if the validator's package is not found.
const fs = require('fs');
const path = require('path');

const folder = process.env.OBSCURA_GLTF_VALIDATOR;
let validator;
try {
    const start = folder ? [folder, path.join(folder, 'node_modules'), path.dirname(folder)] : undefined;
    validator = require(require.resolve('gltf-validator', start ? {paths: start} : undefined));
} catch {
    process.exit(3);
}
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then((report) => {
    console.log(report.issues.numErrors, report.issues.numWarnings);
    for (const message of report.issues.messages)
        if (message.severity <= 1)
            console.log(message.code, message.pointer, message.message);
}, (error) => {
    console.log(String(error));
    process.exit(1);
});
