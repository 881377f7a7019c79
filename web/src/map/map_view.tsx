// SPDX-License-Identifier: MIT

export function MapView({ shown }: { shown: boolean }) {
  return <section class="view" hidden={!shown} />;
}
