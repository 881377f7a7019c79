// SPDX-License-Identifier: MIT
import { render } from "preact";
import { App } from "./app";
import { sitDown } from "./drive/cockpit";
import { robot } from "./robot";
import { strings } from "./strings";
import { tell } from "./ui/notices";
import "./style.css";

robot.onTrouble = (why) => tell(why ?? strings.noAnswer);
robot.start();
sitDown();
render(<App />, document.getElementById("app")!);
