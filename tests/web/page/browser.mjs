// SPDX-License-Identifier: MIT
// A real browser on the page of the real program.
import assert from "node:assert/strict";
import { existsSync, mkdirSync } from "node:fs";
import { after, afterEach, before, beforeEach } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { Robot, until } from "../server/robot.mjs";

export const SIZES = {
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 },
  laptop: { viewport: { width: 1440, height: 900 }, hasTouch: false, isMobile: false, deviceScaleFactor: 1 },
};

const pictures = process.env.PICTURES ?? fileURLToPath(new URL("../../../build/pictures/", import.meta.url));
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync);

/** A browser for the tests of a file, and for each test a robot of its own and what it opens. */
export class Stage {
  constructor(...args) {
    this.args = args;
    before(async () => {
      // Root has no sandbox, and the machine of a test no graphics card.
      const args = ["--no-sandbox", "--disable-gpu", "--force-color-profile=srgb"];
      this.browser = await chromium.launch({ executablePath, args });
    });
    beforeEach(async () => {
      this.pages = [];
      this.robot = await Robot.start(...this.args);
    });
    afterEach(async () => {
      const errors = this.pages.flatMap((page) => page.errors);
      for (const page of this.pages) await page.context().close();
      await this.robot.stop();
      assert.deepEqual(errors, [], "nothing goes wrong in the page that it does not catch");
    });
    after(() => this.browser.close());
  }

  /**
   * The robot's page in a browser's profile of its own. `hash` of the address, `url` for another way to the robot,
   * `prepare` for what is done to the page before it is opened.
   */
  async open(size = "laptop", { hash = "", url = this.robot.url, prepare, ...options } = {}) {
    const context = await this.browser.newContext({ ...SIZES[size], ...options });
    const page = await context.newPage();
    this.pages.push(page);
    page.errors = [];
    page.on("pageerror", (error) => page.errors.push(String(error)));
    page.setDefaultTimeout(20000);
    await prepare?.(page, context);
    await page.goto(`${url}/${hash}`);
    return page;
  }
}

export async function picture(page, name) {
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: `${pictures}/${name}.png` });
}

export const chip = (page, id) => page.locator(`[data-indicator="${id}"]`);

/** Until this page holds the wheel and the robot would obey it. */
export async function ready(page, robot) {
  await page.waitForFunction(() => window.dynslam?.robot.wheel.value.mine);
  await until(async () => (await robot.json("/api/v1/state")).verdict?.motion === "go", "leave to drive");
}

export const speed = async (robot) => (await robot.json("/api/v1/state")).applied?.v_mps ?? 0;
export const turn = async (robot) => (await robot.json("/api/v1/state")).applied?.w_radps ?? 0;
export const drives = (robot) => until(async () => Math.abs(await speed(robot)) > 0.05, "the robot to drive");
export const turns = (robot) => until(async () => Math.abs(await turn(robot)) > 0.1, "the robot to turn");
export const stands = (robot) =>
  until(async () => {
    const { power } = await robot.json("/api/v1/state");
    return power.left === 0 && power.right === 0;
  }, "the robot to stand");

/** A finger on the screen. */
export class Finger {
  static async of(page) {
    return new Finger(await page.context().newCDPSession(page));
  }
  constructor(session) {
    this.session = session;
  }
  touch(type, points) {
    return this.session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  }
  down = (x, y) => this.touch("touchStart", [{ x, y }]);
  move = (x, y) => this.touch("touchMove", [{ x, y }]);
  up = () => this.touch("touchEnd", []);
}

export async function middle(locator) {
  const box = await locator.boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}
