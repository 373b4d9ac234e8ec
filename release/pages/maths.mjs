// Reads equations in LaTeX, a list in JSON, from standard input, and writes them as HTML with KaTeX. An equation that it does not
// understand ends it.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const katex = createRequire(`${process.argv[2]}/`)("katex");
const equations = JSON.parse(readFileSync(0, "utf8"));
const drawn = equations.map((equation) =>
  katex.renderToString(equation, { displayMode: true, throwOnError: true, strict: "error" }),
);
process.stdout.write(JSON.stringify(drawn));
