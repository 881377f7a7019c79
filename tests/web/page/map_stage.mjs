// SPDX-License-Identifier: MIT
import { middle, Stage } from "./browser.mjs";

export const button = (page, name) => page.getByRole("button", { name, exact: true });

/** Opens the autopilot's panel. */
export const openPanel = async (page) => (await page.locator(".pilot-head").getAttribute("aria-expanded")) === "true" || page.locator(".pilot-head").click();

async function pixelsPerMetre(page) {
  const bar = page.locator(".map-scale");
  const [, length, unit] = /([\d.]+) (c?m)/.exec(await bar.innerText());
  return (await bar.evaluate((e) => parseFloat(e.style.width))) / (Number(length) * (unit === "cm" ? 0.01 : 1));
}

/** For tests on the map, and of what people draw on it. */
export class MapStage extends Stage {
  notes = () => this.robot.json("/api/v1/notes");
  put = (path, body) => this.robot.fetch(`/api/v1/notes/${path}`, { method: "PUT", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });

  /** The map at a size, around the robot; `faked`: what the robot's state is made to say; `orders`: where orders go instead. */
  async openMap(size, { faked, orders, ...options } = {}) {
    const page = await this.open(size, {
      hash: "#map",
      ...options,
      prepare: async (page) => {
        await options.prepare?.(page);
        if (faked)
          await page.routeWebSocket(/\/ws\/state$/, (socket) => {
            const robot = socket.connectToServer();
            robot.onMessage((message) => socket.send(JSON.stringify({ ...JSON.parse(message), ...faked() })));
          });
        if (orders)
          await page.route(/\/api\/v1\/(mode|goal)$/, (route) => {
            orders.push([route.request().url().split("/").pop(), route.request().postDataJSON()]);
            return route.fulfill({ status: 204 });
          });
      },
    });
    await page.locator("canvas[data-tile]").first().waitFor();
    return page;
  }

  /** Where a place of the map is on the screen, with the robot in its middle. */
  async screenOf(page) {
    await button(page, "Centre on the robot").click();
    await page.waitForTimeout(600);
    const scale = await pixelsPerMetre(page);
    const centre = await middle(page.locator(".map"));
    const { pose } = await this.robot.json("/api/v1/state");
    return ({ x, y }) => ({ x: centre.x + (x - pose.x_m) * scale, y: centre.y - (y - pose.y_m) * scale });
  }
}
