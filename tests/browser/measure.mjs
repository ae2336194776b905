#!/usr/bin/env node
// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// measure.mjs VSPLIT FILE.pmesh... [--size WIDTHxHEIGHT] [--runs N] [--markdown FILE]: streams each file into the viewer and prints the tasks of
// the page's main thread that took longest, as Chromium's own trace has them. CPU time is what the thread computed; wall time has, too, what it
// waited for: on a machine without a GPU drawing is by software, on the same cores.
import { writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { dirname, basename } from 'node:path';
import { parseArgs } from 'node:util';
import { launch, serve } from './harness.mjs';

const { values, positionals: [vsplit, ...files] } = parseArgs({ allowPositionals: true, options: { size: { type: 'string', default: '400x300' }, runs: { type: 'string', default: '3' }, markdown: { type: 'string' } } });
const [width, height] = values.size.split('x').map(Number);

const names = [[/v8\.produceModuleCache/, 'the compiled script is put into the cache'], [/EvaluateScript|evaluateModule|v8\.compile/, 'the script is loaded'], [/FireAnimationFrame/, 'a frame'], [/HandlePostMessage/, 'a message of the worker'], [/TimerFire/, 'a timer: GL context, shaders'], [/mojo/, 'navigation']];
const median = (numbers) => numbers.toSorted((a, b) => a - b)[Math.floor(numbers.length / 2)];

async function measure(file) {
    const server = await serve(vsplit, dirname(file));
    const browser = await launch();
    try {
        const page = await browser.newPage({ viewport: { width, height } });
        // Scripts in the browser's cache: what is measured is streaming.
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
        const tasks = events.filter((e) => main.has(`${e.pid}/${e.tid}`) && e.ph === 'X' && e.name === 'RunTask' && e.tdur !== undefined);
        if (tasks.length === 0) throw new Error('the trace has no task of the main thread');
        const inside = (task) => {
            const within = events.filter((e) => e.pid === task.pid && e.tid === task.tid && e.ph === 'X' && e.ts >= task.ts && e.ts + e.dur <= task.ts + task.dur).map((e) => e.name).join(' ');
            return names.find(([words]) => words.test(within))?.[1] ?? "the browser's own";
        };
        const longest = tasks.toSorted((a, b) => b.tdur - a.tdur).slice(0, 3).map((task) => ({ cpu: task.tdur / 1000, wall: task.dur / 1000, what: inside(task) }));
        const { update } = await page.evaluate(() => ({ update: window.vsplit.state.longestUpdate }));
        return { file: basename(file), seconds, tasks: tasks.length, longest, update };
    } finally {
        await browser.close();
        server.stop();
    }
}

const rows = [];
for (const file of files) {
    const runs = [];
    for (let i = 0; i < Number(values.runs); ++i) {
        const run = await measure(file);
        runs.push(run);
        console.error(`${run.file}: whole after ${run.seconds.toFixed(1)} s, ${run.tasks} tasks, longest update() ${run.update.toFixed(1)} ms; longest on the CPU: ${run.longest.map((l) => `${l.cpu.toFixed(1)} ms (${l.what}; ${l.wall.toFixed(0)} ms by the clock)`).join(', ')}`);
    }
    const worst = runs.flatMap((run) => run.longest).toSorted((a, b) => b.cpu - a.cpu)[0];
    rows.push(`| ${runs[0].file} | ${[0, 1, 2].map((i) => median(runs.map((run) => run.longest[i].cpu)).toFixed(1)).join(' | ')} | ${worst.cpu.toFixed(1)}: ${worst.what} | ${median(runs.map((run) => run.update)).toFixed(1)} | ${median(runs.map((run) => run.seconds)).toFixed(1)} |`);
}
const text = `<!-- SPDX-FileCopyrightText: 2026 The vsplit authors -->
<!-- SPDX-License-Identifier: MIT -->
# The page's main thread while it streams

Written by \`./run bench web\`: ${values.runs} runs a file in Chromium at ${values.size}, ${cpus().length} cores, GL by software on the same cores, ${new Date().toISOString().slice(0, 10)}. A task is what the main thread does without looking
at input, from navigation to the whole mesh, by Chromium's trace; its CPU time is what that thread computed (\`tdur\`). Times in milliseconds, medians of the runs. The bar is 16 ms for the longest task.

| file | longest task, CPU | second | third | worst of all runs, and what it was | longest \`update()\`, by the clock | whole after, s |
| --- | ---: | ---: | ---: | --- | ---: | ---: |
${rows.join('\n')}
`;
process.stdout.write(text);
if (values.markdown) writeFileSync(values.markdown, text);
