// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT

/** What kind of failure a VsplitError is: those of formats/spec/errors.md, and those of the network. */
export type VsplitErrorCode =
    | 'unsupported' | 'truncated' | 'malformed' | 'checksum' | 'limit' | 'argument'
    | 'network'      // The server cannot be reached, or the connection broke again and again.
    | 'http'         // The server answered with an error.
    | 'not-a-model'  // What came is something else, such as a web page.
    | 'server'       // The server sent other bytes than it was asked for, or the file changed meanwhile.
    | 'memory' | 'cancelled';

/** A failure in words for a person; `offset` is the byte in the file, where it is known. */
export class VsplitError extends Error {
    override readonly name = 'VsplitError';
    constructor(readonly code: VsplitErrorCode, message: string, readonly offset?: number) {
        super(message);
    }
}
