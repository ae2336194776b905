// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
export { VsplitError, type VsplitErrorCode } from './errors.js';
export type { ArrayPatch, AttributeInfo, Level, MeshPatch, OpenOptions, Progress, StreamInfo, Target } from './messages.js';
export { VsplitSession, type SessionHandlers, type SessionOptions } from './session.js';
export { compileVsplit, VsplitStream, type Bounds, type ByteRange, type StreamOptions, type Updated } from './stream.js';
