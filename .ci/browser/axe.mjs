// What WCAG 2.2 AA asks of a page and a program can see.

import { readFileSync } from "node:fs";
import { join } from "node:path";

const axe = readFileSync(join(process.env.PACKAGES, "node_modules/axe-core/axe.min.js"), "utf8");
const RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"];

/** The violations on a page, each with the elements that have it. */
export async function violations(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate((values) => window.axe.run(document, { runOnly: { type: "tag", values } }), RULES);
  return violations.map(({ id, help, nodes }) => {
    const where = nodes.slice(0, 3).map((node) => `${node.target} ${node.any[0]?.message ?? ""}`);
    return `${id}: ${help}: ${nodes.length} times, ${where.join("; ")}`;
  });
}
