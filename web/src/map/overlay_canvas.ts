// SPDX-License-Identifier: MIT
import { effect } from "@preact/signals";
import { DomUtil, type Map as LeafletMap, type ZoomAnimEvent } from "leaflet";
import { inks } from "./look";
import type { Overlay, Pen } from "./overlays/pen";

/** One canvas over the cells. Drawn anew, once a frame, when a signal that an overlay has read changes, or the map moves. */
export class OverlayCanvas {
  private readonly canvas = DomUtil.create("canvas", "leaflet-zoom-animated overlays");
  private readonly context = this.canvas.getContext("2d")!;
  private frame = 0;
  private isHeld = false;
  private shownAtZoom = 0;
  private stopWatching = () => {};

  constructor(
    private readonly map: LeafletMap,
    private readonly overlays: () => Overlay[],
  ) {
    map.getPane("overlayPane")!.append(this.canvas);
    map.on("move resize", () => this.drawSoon());
    map.on("zoom viewreset", () => this.draw()); // at once: the cells have been moved already
    map.on("zoomanim", (event) => this.followZoom(event));
  }

  /** While held nothing is drawn; for when it is not seen. */
  hold(isHeld: boolean): void {
    this.isHeld = isHeld;
    if (!isHeld) this.drawSoon();
  }

  drawSoon(): void {
    if (this.frame === 0 && !this.isHeld) this.frame = requestAnimationFrame(() => this.draw());
  }

  end(): void {
    this.isHeld = true;
    cancelAnimationFrame(this.frame);
    this.stopWatching();
    this.canvas.remove();
  }

  private draw(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    if (this.isHeld) return;
    this.stopWatching();
    let isFirst = true;
    this.stopWatching = effect(() => {
      if (!isFirst) {
        this.drawSoon();
        return;
      }
      isFirst = false;
      const pen = this.layOut();
      for (const overlay of this.overlays()) overlay(pen);
    });
  }

  /** Puts the canvas over what is seen of the map, empty. */
  private layOut(): Pen {
    const { x: width, y: height } = this.map.getSize();
    const sharpness = window.devicePixelRatio;
    const [w, h] = [Math.round(width * sharpness), Math.round(height * sharpness)];
    if (this.canvas.width !== w || this.canvas.height !== h) {
      [this.canvas.width, this.canvas.height] = [w, h];
      [this.canvas.style.width, this.canvas.style.height] = [`${width}px`, `${height}px`];
    }
    const corner = this.map.containerPointToLayerPoint([0, 0]);
    DomUtil.setTransform(this.canvas, corner, 1);
    this.shownAtZoom = this.map.getZoom();
    this.context.setTransform(sharpness, 0, 0, sharpness, 0, 0);
    this.context.clearRect(0, 0, width, height);
    return this.penFor(width, height);
  }

  private penFor(width: number, height: number): Pen {
    const zero = this.map.latLngToContainerPoint([0, 0]);
    const pixelsPerMetre = this.map.project([0, 1]).x - this.map.project([0, 0]).x;
    return {
      context: this.context,
      inks: inks.value,
      pixelsPerMetre,
      width,
      height,
      at: ({ x, y }) => [zero.x + x * pixelsPerMetre, zero.y - y * pixelsPerMetre],
    };
  }

  /** Stretches what is drawn along with the cells until the zoom is reached. */
  private followZoom({ center, zoom }: ZoomAnimEvent): void {
    const corner = this.map.containerPointToLayerPoint([0, 0]);
    const place = this.map.project(this.map.containerPointToLatLng([0, 0]), zoom);
    const newCorner = this.map.project(center, zoom).subtract(this.map.getSize().divideBy(2)).subtract(corner);
    DomUtil.setTransform(this.canvas, place.subtract(newCorner), this.map.getZoomScale(zoom, this.shownAtZoom));
  }
}

