// SPDX-License-Identifier: MIT
/** The libraries that are in this page, and what their licences ask to be shown. */
import fflate from "../../node_modules/fflate/LICENSE";
import leaflet from "../../node_modules/leaflet/LICENSE";
import nipplejs from "../../node_modules/nipplejs/LICENSE";
import preact from "../../node_modules/preact/LICENSE";
import signals from "../../node_modules/@preact/signals/LICENSE";
import uqr from "../../node_modules/uqr/LICENSE";

export interface Library {
  name: string;
  licence: string;
  text: string;
}

export const LIBRARIES: Library[] = [
  { name: "Preact", licence: "MIT", text: preact },
  { name: "Preact Signals", licence: "MIT", text: signals },
  { name: "Leaflet", licence: "BSD-2-Clause", text: leaflet },
  { name: "nipplejs", licence: "MIT", text: nipplejs },
  { name: "fflate", licence: "MIT", text: fflate },
  { name: "uqr", licence: "MIT", text: uqr },
];
