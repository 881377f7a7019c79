// SPDX-License-Identifier: MIT

export function PairView() {
  return <section class="view" />;
}
