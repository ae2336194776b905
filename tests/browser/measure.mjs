#!/usr/bin/env node
// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// measure.mjs VSPLIT FILE.pmesh [WIDTHxHEIGHT]: streams a file into the viewer and prints the tasks of the page's main thread that took
// longest, as Chromium's own trace has them. On a machine without a GPU drawing is by software, in another process.
import { dirname, basename } from 'node:path';
import { launch, serve } from './harness.mjs';

const [vsplit, file, size = '1280x800'] = process.argv.slice(2);
const [width, height] = size.split('x').map(Number);
const server = await serve(vsplit, dirname(file));
const browser = await launch();
try {
    const page = await browser.newPage({ viewport: { width, height } });
    // Scripts compiled and shaders linked before: what is measured is streaming.
    await page.goto(`${server.url}_vsplit/index.html`);
    const client = await page.context().newCDPSession(page);
    const events = [];
    client.on('Tracing.dataCollected', ({ value }) => events.push(...value));
    await client.send('Tracing.start', { transferMode: 'ReportEvents', traceConfig: { includedCategories: ['toplevel', 'devtools.timeline', 'disabled-by-default-devtools.timeline'] } });
    await page.goto(`${server.url}_vsplit/index.html?src=/${basename(file)}`);
    const began = Date.now();
    await page.waitForFunction(() => window.vsplit?.model?.info && window.vsplit.state.level?.triangles === window.vsplit.model.info.triangles, undefined, { timeout: 110_000, polling: 500 });
    const seconds = (Date.now() - began) / 1000;
    const ended = new Promise((resolve) => client.once('Tracing.tracingComplete', resolve));
    await client.send('Tracing.end');
    await ended;
    const main = new Set(events.filter((e) => e.name === 'thread_name' && e.args.name === 'CrRendererMain').map((e) => `${e.pid}/${e.tid}`));
    const tasks = events.filter((e) => main.has(`${e.pid}/${e.tid}`) && e.ph === 'X' && e.name === 'RunTask');
    const start = Math.min(...tasks.map((t) => t.ts));
    const inside = (task) => events.filter((e) => e.pid === task.pid && e.tid === task.tid && e.ph === 'X' && e !== task && e.ts >= task.ts && e.ts + e.dur <= task.ts + task.dur && e.dur > task.dur / 2 && !/RunTask/.test(e.name)).sort((a, b) => b.dur - a.dur).map((e) => e.name);
    const state = await page.evaluate(() => ({ update: window.vsplit.state.longestUpdate, frame: window.vsplit.state.longestFrame }));
    console.log(`${basename(file)}: whole after ${seconds.toFixed(1)} s; longest update() ${state.update.toFixed(1)} ms, longest update and draw ${state.frame.toFixed(1)} ms`);
    for (const [what, time] of [['on the CPU', (task) => task.tdur ?? 0], ['with what it waited for', (task) => task.dur]]) {
        console.log(`the longest of ${tasks.length} tasks, ${what}:`);
        for (const task of tasks.sort((a, b) => time(b) - time(a)).slice(0, 6))
            console.log(`  ${(time(task) / 1000).toFixed(1)} ms at ${((task.ts - start) / 1e6).toFixed(2)} s  ${[...new Set(inside(task))].slice(0, 4).join(' > ')}`);
    }
} finally {
    await browser.close();
    server.stop();
}
