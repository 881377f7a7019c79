// SPDX-License-Identifier: MIT
// Who comes in, who drives, and who may stop: everybody.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { chip, picture, Stage } from "./browser.mjs";

const its = new Stage("--set", "access.simulation_pairs_itself=false");

const ownerCode = () => until(() => /#pair=(\S+)/.exec(its.robot.output)?.[1], "the owner's code");
const role = (page) => page.evaluate(async () => (await (await fetch("api/v1/me")).json()).role);

/** Pairs a page by an invitation of `admin`'s. */
async function invited(admin, as, size) {
  const { code } = await admin.evaluate(async (role) => {
    const answer = await fetch("api/v1/invitations", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ role }) });
    return answer.json();
  }, as);
  const page = await its.open(size, { hash: `#pair=${code}` });
  await page.locator('.app[data-view="drive"]').waitFor();
  return page;
}
async function owner(size) {
  const page = await its.open(size, { hash: `#pair=${await ownerCode()}` });
  await page.locator('.app[data-view="drive"]').waitFor();
  return page;
}
/** The state as somebody sees it who may. */
const state = (page) => page.evaluate(async () => (await fetch("api/v1/state")).json());
const obeys = async (page) => {
  await page.locator('[data-indicator="wheel"].chip-good').waitFor();
  await until(async () => (await state(page)).verdict?.motion === "go", "leave to drive");
};

describe("a stranger", () => {
  it("pairs with the code that the robot prints, and drives within ten seconds", async () => {
    const page = await its.open("phone");
    const began = Date.now();
    await page.locator('.app[data-view="pair"]').waitFor();
    await picture(page, "pair-phone");
    await page.getByLabel("Code").fill((await ownerCode()).toLowerCase());
    await page.keyboard.press("Enter");
    await obeys(page);
    assert.ok(Date.now() - began < 10000);
    assert.equal(await role(page), "admin");
  });

  it("who mistypes the code is told, and can try again", async () => {
    const page = await its.open("laptop");
    await page.getByLabel("Code").fill("AAAA-AAAA");
    await page.keyboard.press("Enter");
    await page.getByRole("alert").first().waitFor();
    await picture(page, "pair-laptop");
    await until(async () => {
      await page.getByLabel("Code").fill(await ownerCode());
      await page.keyboard.press("Enter");
      await page.waitForTimeout(500);
      return (await role(page)) === "admin";
    }, "the right code to be taken", 20000);
  });

  it("stops the robot without any login", async () => {
    const admin = await owner("laptop");
    await obeys(admin);
    await admin.keyboard.down("KeyA");
    await until(async () => Math.abs((await state(admin)).applied.w_radps) > 0.1, "the robot to turn");
    const stranger = await its.open("phone");
    await stranger.locator('.app[data-view="pair"]').waitFor();
    await stranger.getByRole("button", { name: "STOP" }).tap();
    await until(async () => (await state(admin)).verdict.motion === "e-stop", "the stop");
    const { power } = await state(admin);
    assert.deepEqual(power, { left: 0, right: 0 });
    await admin.keyboard.up("KeyA");
  });
});

describe("the wheel", () => {
  it("is one person's at a time, taken over only on request", async () => {
    const ada = await owner("laptop");
    await obeys(ada);
    const bob = await invited(ada, "driver", "phone");
    await bob.getByRole("button", { name: /Take the wheel from/ }).waitFor();
    await picture(bob, "wheel-taken-phone");
    assert.equal(await bob.locator(".joystick").count(), 0, "who has not the wheel has no stick");
    await ada.keyboard.down("KeyA");
    await until(async () => Math.abs((await state(ada)).applied.w_radps) > 0.1, "Ada to drive");
    await bob.getByRole("button", { name: /Take the wheel from/ }).tap();
    await obeys(bob);
    await until(async () => (await state(ada)).power.left === 0, "the robot to stand until Bob drives");
    await ada.keyboard.up("KeyA");
    await ada.keyboard.down("KeyA");
    await ada.waitForTimeout(500);
    assert.equal((await state(ada)).power.left, 0, "Ada drives no more");
    await ada.getByRole("button", { name: /Take the wheel from/ }).waitFor();
    await ada.keyboard.up("KeyA");
  });

  it("is free again when its page is closed", async () => {
    const ada = await owner("laptop");
    const bob = await invited(ada, "driver", "phone");
    await bob.getByRole("button", { name: /Take the wheel from/ }).waitFor();
    await ada.close();
    await bob.locator('[data-indicator="wheel"].chip-good').or(bob.getByRole("button", { name: "Take the wheel", exact: true })).first().waitFor();
  });
});

describe("a viewer", () => {
  it("watches and cannot drive, but can stop", async () => {
    const ada = await owner("laptop");
    await obeys(ada);
    const eve = await invited(ada, "viewer", "phone");
    await eve.getByText("You may watch. Only a driver may drive.").waitFor();
    assert.equal(await eve.locator(".joystick").count(), 0);
    const refused = await eve.evaluate(async () => (await fetch("api/v1/power_limit", { method: "POST", headers: { "Content-Type": "application/json" }, body: '{"power_limit":0.1}' })).status);
    assert.equal(refused, 403);
    assert.match(await chip(eve, "battery").innerText(), /%/);
    await picture(eve, "viewer-phone");
    await eve.getByRole("button", { name: "STOP" }).tap();
    await until(async () => (await state(ada)).verdict.motion === "e-stop", "the stop");
    await eve.getByRole("alert").filter({ hasText: "stopped" }).waitFor();
    assert.equal(await eve.getByRole("button", { name: "Clear the stop" }).count(), 0);
    await ada.getByRole("button", { name: "Clear the stop" }).click();
    await obeys(ada);
  });
});
