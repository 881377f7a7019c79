// SPDX-License-Identifier: MIT

export function MoreView() {
  return <section class="view" />;
}
