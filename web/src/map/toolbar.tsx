// SPDX-License-Identifier: MIT
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { strings } from "../strings";
import { Icon, type IconName } from "../ui/icons";
import { layers, LAYERS, switchLayer } from "./layers";
import { savePicture } from "./save_picture";
import { follows, maySend, takeTool, tool } from "./tools";

interface Actions {
  centre: () => void;
  zoomBy: (steps: number) => void;
}

export function Toolbar({ centre, zoomBy }: Actions) {
  const isOpen = useSignal(false);
  const words = strings.map;
  return (
    <div class="map-side">
      {isOpen.value && <LayerMenu />}
      <div class="map-tools" role="toolbar" aria-label={words.tools} aria-orientation="vertical">
        <ToolButton icon="follow" title={words.follow} isOn={follows.value} onClick={() => (follows.value = !follows.value)} />
        <ToolButton icon="centre" title={words.centre} onClick={centre} />
        <ToolButton icon="zoomIn" title={words.zoomIn} onClick={() => zoomBy(1)} />
        <ToolButton icon="zoomOut" title={words.zoomOut} onClick={() => zoomBy(-1)} />
        {maySend.value && <ToolButton icon="flag" title={words.goTool} isOn={tool.value === "goal"} onClick={() => takeTool("goal")} />}
        {maySend.value && <ToolButton icon="noGo" title={words.areaTool} isOn={tool.value === "area"} onClick={() => takeTool("area")} />}
        <ToolButton icon="measure" title={words.measure} isOn={tool.value === "measure"} onClick={() => takeTool("measure")} />
        <ToolButton icon="layers" title={words.layers} isOn={isOpen.value} onClick={() => (isOpen.value = !isOpen.value)} />
        <ToolButton icon="save" title={words.save} onClick={() => void savePicture()} />
      </div>
    </div>
  );
}

function ToolButton({ icon, title, isOn, onClick }: { icon: IconName; title: string; isOn?: boolean; onClick: () => void }) {
  return (
    <button type="button" class="map-tool" title={title} aria-label={title} aria-pressed={isOn} onClick={onClick}>
      <Icon name={icon} />
    </button>
  );
}

function LayerMenu() {
  return (
    <fieldset class="map-layers">
      <legend>{strings.map.layers}</legend>
      {LAYERS.map((layer) => (
        <label key={layer}>
          <input type="checkbox" checked={layers.value[layer]} onChange={(event) => switchLayer(layer, event.currentTarget.checked)} onClick={leave} />
          {strings.map.layerNames[layer]}
        </label>
      ))}
    </fieldset>
  );
}

/** After a click of the mouse the space bar is to stop the robot again; who goes by keys keeps his place. */
function leave(event: JSX.TargetedMouseEvent<HTMLInputElement>): void {
  if (event.detail > 0) event.currentTarget.blur();
}
