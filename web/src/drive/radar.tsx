// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { robot } from "../robot";
import { strings } from "../strings";

/** How old the newest scan was when it was drawn, milliseconds; null before there was one. */
export const scanAge_ms = signal<number | null>(null);

const NEAR_CM = 40;
/** Half of the robot's length and width, metres, for its picture. */
const BODY_M = { length: 0.14, width: 0.12 };

/** An older scan is no picture of what is around now. */
export const OLD_SCAN_MS = 500;
const LOOK_EVERY_MS = 200;

/** A distance that shows what is around, in steps, so that the picture does not breathe. */
export function radiusFor(ranges_cm: readonly number[]): number {
  const near = ranges_cm.filter((cm) => cm > 0).sort((a, b) => a - b);
  const typical_m = (near[Math.floor(near.length * 0.8)] ?? 300) / 100;
  return [1.5, 3, 6, 12].find((radius) => radius >= typical_m) ?? 12;
}

interface Style {
  ring: string;
  point: string;
  near: string;
  robot: string;
}

function styleOf(element: Element): Style {
  const style = getComputedStyle(element);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return { ring: colour("--radar-ring"), point: colour("--radar-point"), near: colour("--radar-near"), robot: colour("--radar-robot") };
}

/** The newest scan from above, ahead is up (thesis, figure 3.2). */
function draw(canvas: HTMLCanvasElement, ranges_cm: readonly number[], style: Style): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  const side = canvas.width;
  const radius_m = radiusFor(ranges_cm);
  const scale = side / 2 / radius_m;
  context.clearRect(0, 0, side, side);
  context.save();
  context.translate(side / 2, side / 2);
  context.strokeStyle = style.ring;
  context.fillStyle = style.ring;
  context.lineWidth = side / 250;
  context.font = `${side / 14}px system-ui`;
  for (const share of [1 / 3, 2 / 3]) {
    context.beginPath();
    context.arc(0, 0, share * radius_m * scale, 0, 2 * Math.PI);
    context.stroke();
    context.fillText(`${+(share * radius_m).toFixed(1)} m`, side / 60, -share * radius_m * scale - side / 80);
  }
  const dot = Math.max(2, side / 70);
  ranges_cm.forEach((cm, degree) => {
    if (cm === 0) return;
    const angle = (degree * Math.PI) / 180;
    const x = -Math.sin(angle) * (cm / 100) * scale;
    const y = -Math.cos(angle) * (cm / 100) * scale;
    context.fillStyle = cm < NEAR_CM ? style.near : style.point;
    context.fillRect(x - dot / 2, y - dot / 2, dot, dot);
  });
  drawRobot(context, scale, style.robot);
  context.restore();
}

function drawRobot(context: CanvasRenderingContext2D, scale: number, colour: string): void {
  const [length, width] = [Math.max(BODY_M.length * scale, 6), Math.max(BODY_M.width * scale, 5)];
  context.fillStyle = colour;
  context.beginPath();
  context.moveTo(0, -length * 1.25);
  context.lineTo(width, -length * 0.4);
  context.lineTo(width, length);
  context.lineTo(-width, length);
  context.lineTo(-width, -length * 0.4);
  context.fill();
}

export function Radar() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let seq = 0;
    let frame = 0;
    const stop = robot.state.subscribe((state) => {
      const scan = state?.scan;
      if (!scan || scan.seq === seq || frame !== 0) return;
      frame = requestAnimationFrame(() => {
        frame = 0;
        seq = scan.seq;
        const element = canvas.current;
        if (!element) return;
        draw(element, scan.ranges_cm, styleOf(element));
        scanAge_ms.value = robot.clock.age_ms(scan.t_s, performance.now());
      });
    });
    const ageing = setInterval(() => {
      const scan = robot.state.peek()?.scan;
      const age_ms = scan ? robot.clock.age_ms(scan.t_s, performance.now()) : null;
      canvas.current?.classList.toggle("radar-old", age_ms === null || age_ms > OLD_SCAN_MS);
    }, LOOK_EVERY_MS);
    return () => {
      stop();
      clearInterval(ageing);
      cancelAnimationFrame(frame);
    };
  }, []);
  return <canvas class="radar" ref={canvas} width={360} height={360} role="img" aria-label={strings.drive.radar} />;
}
