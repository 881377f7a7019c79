// SPDX-License-Identifier: MIT

export function DriveView() {
  return <section class="view" />;
}
