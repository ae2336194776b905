// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "rebake.hpp"

namespace vsplit::studio {

void start_rebake(Rebake& rebake, Mesh mesh, bake::CollapseOptions options) {
    rebake.start([mesh = std::move(mesh), options = std::move(options)](const Rebake::Job& job) {
        bake::CollapseOptions first = options;
        first.calibrate = first.put_off_outliers = false;
        auto recorded = bake::collapse(
            mesh, first, [&](std::string_view, double done) { return job.progress(0.3 * done); });
        const bool ok = recorded.ok();
        job.give({std::move(recorded), !ok});
        if (!ok) return;
        auto measured = bake::collapse(mesh, options, [&](std::string_view stage, double done) {
            return job.progress(stage == "collapse" ? 0.3 + 0.3 * done : 0.6 + 0.4 * done);
        });
        job.give({std::move(measured), true});
    });
}

void start_search(WeightSearch& search, Mesh mesh, bake::Marks marks, bake::Keep wish,
                  bake::CollapseOptions options) {
    search.start([mesh = std::move(mesh), marks = std::move(marks), wish = std::move(wish),
                  options = std::move(options)](const WeightSearch::Job& job) mutable {
        // A search makes about ten records; each begins anew.
        constexpr double kRecords = 10;
        double records = 0, last = 0;
        auto found =
            bake::find_weights(mesh, marks, {&wish, 1}, options, [&](std::string_view stage, double done) {
                const double all = stage == "collapse" ? 0.5 * done : 0.5 + 0.5 * done;
                if (all < last) ++records;
                last = all;
                const double made = records + all;
                return job.progress(made / (made + kRecords / 2) * (1 + 0.5 / kRecords));
            });
        job.give({std::move(wish), std::move(found)});
    });
}

}  // namespace vsplit::studio
