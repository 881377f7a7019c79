// SPDX-License-Identifier: MIT
// Checks requests and answers against web/openapi.yaml, with a validator that is not ours.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import Ajv from "ajv/dist/2020.js";
import addFormats from "ajv-formats";
import { parse } from "yaml";

export const contract = parse(readFileSync(new URL("../../../web/openapi.yaml", import.meta.url), "utf8"));
const ajv = new Ajv({ strict: false, allErrors: true });
addFormats(ajv);
ajv.addSchema({ $id: "contract", ...contract });

const pointer = (...steps) =>
  "contract#/" + steps.map((s) => encodeURIComponent(String(s).replaceAll("~", "~0").replaceAll("/", "~1"))).join("/");

function check(at, value, what) {
  const validate = ajv.getSchema(at);
  assert.ok(validate, `no schema at ${at}`);
  assert.ok(validate(value), `${what}: ${ajv.errorsText(validate.errors)}\n${JSON.stringify(value).slice(0, 500)}`);
}
export const checkSchema = (name, value) => check(pointer("components", "schemas", name), value, name);
export const isSchema = (name, value) => ajv.getSchema(pointer("components", "schemas", name))(value);

/** All operations: [method, path, operation]. */
export const operations = Object.entries(contract.paths).flatMap(([path, methods]) =>
  Object.entries(methods).filter(([m]) => ["get", "post", "delete", "put", "patch"].includes(m))
    .map(([method, operation]) => [method, path, operation]));

/** Whether the contract takes this for the body of a request. */
export function takesBody(method, path, body) {
  const content = contract.paths[path][method].requestBody?.content?.["application/json"];
  if (!content) return body === undefined;
  return ajv.getSchema(pointer("paths", path, method, "requestBody", "content", "application/json", "schema"))(body);
}

/** Checks an answer of fetch() to an operation; returns its body. */
export async function checkAnswer(method, path, answer) {
  const operation = contract.paths[path][method];
  const what = `${method} ${path} -> ${answer.status}`;
  let status = operation.responses[answer.status] ? String(answer.status) : "default";
  let response = operation.responses[status];
  assert.ok(response, `${what} is not in the contract`);
  let at = ["paths", path, method, "responses", status];
  if (response.$ref) {
    at = response.$ref.slice(2).split("/");
    response = at.reduce((node, step) => node[step], contract);
  }
  assert.equal(answer.headers.get("x-content-type-options"), "nosniff", what);
  assert.match(answer.headers.get("content-security-policy"), /default-src 'none'.*frame-ancestors 'none'/, what);
  if (!response.content) {
    assert.equal(await answer.text(), "", what);
    return undefined;
  }
  const type = answer.headers.get("content-type");
  assert.ok(response.content[type], `${what} has type ${type}, not ${Object.keys(response.content)}`);
  if (type !== "application/json") return Buffer.from(await answer.arrayBuffer());
  const body = await answer.json();
  check(pointer(...at, "content", type, "schema"), body, what);
  return body;
}
