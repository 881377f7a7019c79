// SPDX-License-Identifier: MIT
/** All that the page says, in one place, for whoever wants it to say it in another language. */
export const strings = {
  app: "dynslam",
  views: { drive: "Drive", map: "Map", more: "More" },
  stop: "STOP",
  stopTitle: "Stop the robot now, until somebody clears it",
  clearStop: "Clear the stop",
  noAnswer: "The robot does not answer.",
  close: "Close",
  link: {
    connecting: "Connecting to the robot …",
    lost: "Connection lost. The robot has stopped by itself. Trying again …",
    stopped: "The robot is stopped",
  },
  wheel: {
    take: "Take the wheel",
    takeOver: (name: string) => `Take the wheel from ${name}`,
    others: (name: string) => `${name} has the wheel.`,
    free: "Nobody has the wheel.",
    mine: "You have the wheel",
    viewer: "You may watch. Only a driver may drive.",
    release: "Let go of the wheel",
  },
};
