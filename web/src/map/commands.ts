// SPDX-License-Identifier: MIT
export function setGoalAtCentre(): void {}
export function resetGoal(): void {}
export function zoomBy(..._: number[]): void {}
export function centre(): void {}
export function pan(..._: number[]): void {}
