// SPDX-License-Identifier: MIT
import { useState } from "preact/hooks";
import { strings } from "../strings";
import { Part, Trouble } from "./parts";

export function MapsSection() {
  const words = strings.more.maps;
  const [time, setTime] = useState(() => Date.now());
  const [isBroken, setBroken] = useState(false);
  const refresh = () => {
    setBroken(false);
    setTime(Date.now());
  };
  return (
    <>
      <Part title={words.preview}>
        <Trouble text={isBroken ? words.none : null} />
        {!isBroken && <img class="map-preview" src={`api/v1/map.png?at=${time}`} alt={words.alt} onError={() => setBroken(true)} />}
        <div class="buttons"><button type="button" onClick={refresh}>{words.refresh}</button></div>
      </Part>
      <Part title={words.picture}>
        <p>{words.pictureWhat}</p>
        <div class="buttons"><Download name="map.png" /></div>
      </Part>
      <Part title={words.ros}>
        <p>{words.rosWhat}</p>
        <div class="buttons">
          <Download name="map.pgm" />
          <Download name="map.yaml" />
        </div>
      </Part>
    </>
  );
}

function Download({ name }: { name: string }) {
  return <a class="button" href={`api/v1/${name}`} download={name}>{strings.more.maps.download(name)}</a>;
}
