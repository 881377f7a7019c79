// SPDX-License-Identifier: MIT
import { Banner } from "./ui/banner";
import { DriveView } from "./drive/drive_view";
import { IndicatorBar } from "./indicators/indicator_bar";
import { MapView } from "./map/map_view";
import { MoreView } from "./more/more_view";
import { PairView } from "./more/pair_view";
import { robot } from "./robot";
import { strings } from "./strings";
import { Notices } from "./ui/notices";
import { StopButton } from "./ui/stop_button";
import { show, view, VIEWS } from "./ui/view";

export function App() {
  const stranger = robot.phase.value === "stranger";
  return (
    <div class="app" data-view={stranger ? "pair" : view.value}>
      <Banner />
      {stranger ? <PairView /> : <Views />}
      <footer class="bar">
        {!stranger && <Tabs />}
        <StopButton />
      </footer>
      <Notices />
    </div>
  );
}

/** The map stays, though hidden: it is dear to build, and keeps where one looked. */
function Views() {
  return (
    <main class="views">
      {view.value === "drive" && <DriveView />}
      <MapView shown={view.value === "map"} />
      {view.value === "map" && (
        <div class="over-map">
          <IndicatorBar loudOnly />
        </div>
      )}
      {view.value === "more" && <MoreView />}
    </main>
  );
}

function Tabs() {
  return (
    <nav class="tabs" aria-label={strings.app}>
      {VIEWS.map((name) => (
        <button key={name} type="button" class={`tab tab-${name}`} aria-current={view.value === name ? "page" : undefined} onClick={() => show(name)}>
          {strings.views[name]}
        </button>
      ))}
    </nav>
  );
}
