// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";

const SHOWN_MS = 5000;
const MOST = 3;

interface Notice {
  id: number;
  text: string;
}

const notices = signal<Notice[]>([]);
let lastId = 0;

/** Says something in passing. The same thing twice is said once. */
export function tell(text: string): void {
  const id = ++lastId;
  notices.value = [...notices.value.filter((notice) => notice.text !== text), { id, text }].slice(-MOST);
  setTimeout(() => {
    notices.value = notices.value.filter((notice) => notice.id !== id);
  }, SHOWN_MS);
}

export function Notices() {
  return (
    <div class="notices" role="status" aria-live="polite">
      {notices.value.map((notice) => (
        <p key={notice.id}>{notice.text}</p>
      ))}
    </div>
  );
}
