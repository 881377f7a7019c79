// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { browserName } from "../../../web/src/more/browser_name";
import { ageText, clockText, countText, longAgeText, recordedAt, sizeText } from "../../../web/src/more/format";
import { cleanCode, codeInHash } from "../../../web/src/more/pairing_code";

test("sizes have at most three digits and go on to the next unit in time", () => {
  assert.deepEqual([0, 999, 1000, 9949, 9951, 113384, 999499, 999501, 1.2e9, 5e15].map((bytes) => sizeText(bytes).replace("\u00a0", " ")), ["0 B", "999 B", "1.0 kB", "9.9 kB", "10 kB", "113 kB", "999 kB", "1.0 MB", "1.2 GB", "5000 TB"]);
});

test("large counts are grouped", () => {
  assert.deepEqual([0, 999, 1000, 1234567].map(countText), ["0", "999", "1\u202f000", "1\u202f234\u202f567"]);
});

test("times as a clock shows them", () => {
  assert.deepEqual([-1, 0, 59.9, 60, 187, 3600, 45296].map(clockText), ["0 s", "0 s", "59 s", "1:00", "3:07", "1:00:00", "12:34:56"]);
});

test("ages of samples in tenths of a second, until they are old", () => {
  assert.deepEqual([0, 340, 9949, 9950, 59600].map(ageText), ["0.0 s", "0.3 s", "9.9 s", "10 s", "1:00"]);
});

test("ages of sessions in the unit that fits; a wall clock that is behind makes no negative ones", () => {
  assert.deepEqual([-50, 89, 90, 5399, 5400, 129600].map(longAgeText), ["", "", "2 min", "90 min", "2 h", "2 days"]);
});

test("the name of a recording tells when it was begun, in UTC", () => {
  assert.equal(recordedAt("recording-20261126-111303.mcap")?.toISOString(), "2026-11-26T11:13:03.000Z");
  assert.equal(recordedAt("recording-20261126-111303-2.mcap")?.toISOString(), "2026-11-26T11:13:03.000Z");
  for (const name of ["ring-000001.mcap", "recording-141.mcap", "recording-20261340-111303.mcap", "recording-20260231-111303.mcap", "recording-20260131-251303.mcap"]) assert.equal(recordedAt(name), null, name);
});

test("codes are read as the robot reads them", () => {
  for (const typed of ["ABCD-2345", "abcd2345", " abcd 2345 ", "AB-CD-23-45", "abcd\u20132345"]) assert.equal(cleanCode(typed), "ABCD-2345", typed);
  assert.equal(cleanCode("oil0-oil0"), "0110-0110");
  for (const typed of ["", "ABCD-234", "ABCD-23456", "ABCD-234U", "ÄBCD-2345", "ABCD_2345"]) assert.equal(cleanCode(typed), null, typed);
});

test("the code of a link", () => {
  assert.equal(codeInHash("#pair=ABCD-2345"), "ABCD-2345");
  for (const hash of ["", "#drive", "#pair=", "#pair=A B", "#pair=<b>", `#pair=${"A".repeat(65)}`]) assert.equal(codeInHash(hash), null, hash);
});

test("browsers by the names that people have for them", () => {
  const webkit = "AppleWebKit/537.36 (KHTML, like Gecko)";
  const cases: [string, number, string][] = [
    ["Mozilla/5.0 (iPhone; CPU iPhone OS 17_4 like Mac OS X) AppleWebKit/605.1.15 Version/17.4 Mobile/15E148 Safari/604.1", 5, "iPhone"],
    ["Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 Version/17.4 Safari/605.1.15", 5, "iPad"],
    ["Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 Version/17.4 Safari/605.1.15", 0, "Safari on macOS"],
    [`Mozilla/5.0 (Linux; Android 14; Pixel 8) ${webkit} Chrome/124.0 Mobile Safari/537.36`, 5, "Android phone"],
    [`Mozilla/5.0 (Linux; Android 14; SM-X710) ${webkit} Chrome/124.0 Safari/537.36`, 5, "Android tablet"],
    [`Mozilla/5.0 (Windows NT 10.0; Win64; x64) ${webkit} Chrome/124.0 Safari/537.36 Edg/124.0`, 0, "Edge on Windows"],
    ["Mozilla/5.0 (X11; Linux x86_64; rv:125.0) Gecko/20100101 Firefox/125.0", 0, "Firefox on Linux"],
    [`Mozilla/5.0 (X11; CrOS x86_64 14541.0.0) ${webkit} Chrome/124.0 Safari/537.36`, 0, "Chrome on ChromeOS"],
    ["curl/8.0", 0, "Browser"],
  ];
  for (const [agent, touchPoints, name] of cases) assert.equal(browserName(agent, touchPoints), name, agent);
});
