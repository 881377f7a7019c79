// SPDX-License-Identifier: MIT
import { robot } from "../robot";
import { strings } from "../strings";

/** Stands in the joystick's place while this page may not steer, and says why. */
export function WheelButton() {
  const { mine, driver } = robot.wheel.value;
  if (!robot.mayDrive) return <p class="wheel-words">{strings.wheel.viewer}</p>;
  if (mine) return null;
  if (driver === null)
    return <button type="button" class="primary" onClick={() => robot.takeWheel(false)}>{strings.wheel.take}</button>;
  return (
    <div class="wheel-words">
      <p>{strings.wheel.others(driver)}</p>
      <button type="button" class="primary" onClick={() => robot.takeWheel(true)}>{strings.wheel.takeOver(driver)}</button>
    </div>
  );
}
