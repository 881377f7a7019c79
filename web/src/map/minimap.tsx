// SPDX-License-Identifier: MIT
export function Minimap({ size, onTap }: { size: "small" | "medium" | "large"; onTap: () => void }) {
  return <button type="button" class={`minimap minimap-${size}`} onClick={onTap} />;
}
