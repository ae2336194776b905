// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Keeps the page from waiting for the GPU: a frame is not begun while the one before the last is still being drawn. Where drawing is
// slow frames become fewer, and the page stays as quick as ever.

export class Pace {
    private readonly fences: WebGLSync[] = [];

    constructor(private readonly gl: WebGL2RenderingContext, private readonly ahead = 1) {
        // Fences of a context that was lost are never signalled.
        for (const event of ['webglcontextlost', 'webglcontextrestored']) gl.canvas.addEventListener(event, () => { this.fences.length = 0; });
    }

    /** Whether a frame may be drawn now. */
    free(): boolean {
        while (this.fences.length > 0) {
            const status = this.gl.getSyncParameter(this.fences[0], this.gl.SYNC_STATUS);
            if (status !== this.gl.SIGNALED && !this.gl.isContextLost()) break;
            this.gl.deleteSync(this.fences.shift()!);
        }
        return this.fences.length <= this.ahead;
    }

    /** After a frame. */
    drawn() {
        const fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        if (fence) this.fences.push(fence);
        this.gl.flush();
    }
}
