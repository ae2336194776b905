// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "../bytes/checksum.hpp"
#include "../bytes/layout.hpp"
#include "stream_state.hpp"

namespace vsplit {
namespace {

/// Splits between two looks at the clock.
constexpr std::size_t kStride = 4096;

}  // namespace

// ---- Bytes in

/// Reads what the front holds so far; asks for more of it by growing it.
Status Stream::State::take_front() {
    const auto bytes = front.bytes().first(front.prefix());
    if (bytes.empty()) return Ok{};
    if (!info) {
        auto read = read_info(bytes, options.limits);
        if (!read) {
            Error what = read.error();
            // Damage is asked for again; what cannot be a .pmesh is not.
            if (what.code == ErrorCode::kChecksum) {
                front = Gather(0, kFirstRequest);
                return retry(kFront, std::move(what));
            }
            if (what.code != ErrorCode::kTruncated) return fail(std::move(what), true);
            if (file_size && bytes.size() >= *file_size) return fail(std::move(what), true);
            if (bytes.size() >= kHeaderBytes) {
                // The header is sound: where the table ends can be believed, within the limits.
                std::uint64_t end = kHeaderBytes;
                for (const std::size_t part : {kDetailsBytesAt, kBaseBytesAt, kTableBytesAt})
                    end += get<std::uint32_t>(bytes, part);
                if (end > options.limits.max_bytes)
                    return fail({ErrorCode::kLimit,
                                 "the table ends at byte " + std::to_string(end) + ", the limit is " +
                                     std::to_string(options.limits.max_bytes),
                                 kTableBytesAt, 0},
                                true);
                front.grow(std::size_t(end));
            }
            return Ok{};
        }
        if (file_size && *file_size != read->file_bytes)
            return fail({ErrorCode::kMalformed,
                         "the server's file has " + std::to_string(*file_size) + " bytes, its table says " +
                             std::to_string(read->file_bytes),
                         read->table_offset, 0},
                        true);
        for (const BlockInfo& block : read->blocks)
            if (block.bytes > options.limits.max_bytes)
                return fail({ErrorCode::kLimit, "a block of " + std::to_string(block.bytes) + " bytes",
                             block.offset, 0},
                            true);
        info = *std::move(read);
    }
    auto begun =
        BlockDecoder::begin(bytes.first(std::min<std::size_t>(bytes.size(), std::size_t(info->data_offset))),
                            options.limits, options.decode_base);
    if (!begun) {
        Error what = begun.error();
        if (what.code != ErrorCode::kChecksum) return fail(std::move(what), true);
        front = Gather(0, kFirstRequest);
        info.reset();
        return retry(kFront, std::move(what));
    }
    decoder = *std::move(begun);
    live.begin(decoder->mesh(), info->vertices, info->triangles, info->splits, info->corner_changes,
               info->moves, grid_of(*info));
    if (info->blocks.empty()) decoder.reset();
    return selective_wanted ? begin_selective() : Ok{};
}

Status Stream::State::take_block(std::size_t block) {
    auto at = pending.find(block);
    std::vector<std::byte> bytes = at->second.release();
    pending.erase(at);
    if (checksum32(bytes) != info->blocks[block].checksum) {
        pending_bytes -= bytes.size();
        return retry(block,
                     {ErrorCode::kChecksum, "block " + std::to_string(block) + "'s checksum does not match",
                      info->blocks[block].offset, 0});
    }
    whole.emplace(block, std::move(bytes));
    return Ok{};
}

/// Makes room by letting go of the blocks that are needed last, but for `keep`.
void Stream::State::drop_far(std::size_t keep) {
    while (pending_bytes > options.max_pending_bytes) {
        std::size_t far = keep;
        if (!pending.empty()) far = std::max(far, pending.rbegin()->first);
        if (!whole.empty()) far = std::max(far, whole.rbegin()->first);
        if (far == keep) return;
        pending_bytes -= info->blocks[far].bytes;
        pending.erase(far);
        whole.erase(far);
    }
}

Status Stream::feed(std::uint64_t offset, std::span<const std::byte> bytes) {
    State& s = *state_;
    Status status = Ok{};
    // The front may have to grow more than once: header, then table.
    while (!s.broken && !ready()) {
        const std::size_t taken = s.front.add(offset, bytes);
        if (taken == 0) return status;
        s.received += taken;
        const std::size_t before = std::size_t(s.front.end());
        if (Status took = s.take_front(); !took) return took;
        if (!ready() && std::size_t(s.front.end()) == before) return status;
    }
    if (s.broken || bytes.empty()) return s.broken && s.error ? Status(*s.error) : status;
    // What the first request brought beyond the front belongs to blocks.
    const auto deliver = [&](std::uint64_t from, std::span<const std::byte> piece) {
        const auto& blocks = s.info->blocks;
        auto block =
            std::size_t(std::upper_bound(blocks.begin(), blocks.end(), from,
                                         [](std::uint64_t x, const BlockInfo& b) { return x < b.offset; }) -
                        blocks.begin());
        if (block > 0) --block;
        for (; block < blocks.size() && blocks[block].offset < from + piece.size(); ++block) {
            const BlockInfo& b = blocks[block];
            if (b.offset + b.bytes <= from || s.has(block) || block < s.decoded) continue;
            if (s.lent && block == s.decoded) continue;
            auto at = s.pending.find(block);
            if (at == s.pending.end()) {
                const std::size_t next = s.decoded + (s.lent ? 1 : 0);
                // The next one always; others while there is room.
                if (block != next && s.pending_bytes + b.bytes > s.options.max_pending_bytes) continue;
                at = s.pending.emplace(block, Gather(b.offset, b.bytes)).first;
                s.pending_bytes += b.bytes;
                s.drop_far(block);
            }
            s.received += at->second.add(from, piece);
            if (!at->second.complete()) continue;
            if (Status took = s.take_block(block); !took) status = took;
        }
    };
    if (s.front.prefix() > s.info->data_offset) {
        const std::uint64_t from = s.info->data_offset;
        std::vector<std::byte> rest(s.front.bytes().begin() + std::ptrdiff_t(from),
                                    s.front.bytes().begin() + std::ptrdiff_t(s.front.prefix()));
        s.front = Gather(0, std::size_t(from));  // only its end is looked at from here on
        s.received -= rest.size();               // counted again as parts of blocks
        deliver(from, rest);
    }
    deliver(offset, bytes);
    return status;
}

Status Stream::set_file_size(std::uint64_t bytes) {
    State& s = *state_;
    s.file_size = bytes;
    if (s.broken) return s.error ? Status(*s.error) : Status(Ok{});
    if (s.info && s.info->file_bytes != bytes)
        return s.fail({ErrorCode::kMalformed,
                       "the server's file has " + std::to_string(bytes) + " bytes, its table says " +
                           std::to_string(s.info->file_bytes),
                       s.info->table_offset, 0},
                      true);
    if (!s.info && s.front.prefix() > 0) return s.take_front();
    return Ok{};
}

std::vector<ByteRange> Stream::wants(std::uint64_t most_bytes, std::size_t ahead) const {
    const State& s = *state_;
    std::vector<ByteRange> out;
    if (s.broken) return out;
    most_bytes = std::max<std::uint64_t>(most_bytes, 1);
    if (!ready()) {
        const auto [from, to] = s.front.gap();
        std::uint64_t end = to;
        if (s.file_size) end = std::min(end, *s.file_size);
        if (end > from)
            out.push_back({from, std::min<std::uint64_t>(
                                     end - from, std::max<std::uint64_t>(most_bytes, kFirstRequest))});
        return out;
    }
    const std::size_t until =
        s.blocks_for_target() + std::min(ahead, s.info->blocks.size() - s.blocks_for_target());
    std::uint64_t left = most_bytes;
    for (std::size_t block = s.decoded + (s.lent ? 1 : 0); block < until && left > 0; ++block) {
        if (s.has(block)) continue;
        const BlockInfo& b = s.info->blocks[block];
        std::pair<std::size_t, std::size_t> gap{0, b.bytes};
        if (const auto at = s.pending.find(block); at != s.pending.end()) gap = at->second.gap();
        const ByteRange range{b.offset + gap.first, std::min<std::uint64_t>(gap.second - gap.first, left)};
        if (!out.empty() && out.back().offset + out.back().size == range.offset)
            out.back().size += range.size;
        else
            out.push_back(range);
        left -= range.size;
    }
    return out;
}

Result<Updated> Stream::update(const Budget& budget) {
    State& s = *state_;
    Updated out;
    if (!ready()) {
        if (s.broken && s.error) return *s.error;
        out.wants_bytes = true;
        return out;
    }
    const auto late = [&] { return budget.out_of_time && budget.out_of_time(); };
    std::size_t blocks = 0;
    bool stop = false;
    while (!s.broken && s.decoder && s.decoded < s.blocks_for_target() && s.whole.contains(s.decoded)) {
        if (blocks >= budget.max_blocks || (blocks > 0 && late())) {
            stop = true;
            break;
        }
        auto job = take_job();
        if (!job) break;
        job->run();
        if (Status done = finish_job(std::move(*job)); !done) return done.error();
        ++blocks;
    }
    if (s.selective) {
        const bool settled = s.update_selective(budget, out);
        const bool all = s.decoded >= s.blocks_for_target();
        out.reached = all && settled;
        out.wants_bytes = !all && !stop && !s.lent && !s.broken && !s.whole.contains(s.decoded);
        return out;
    }
    const std::size_t wanted = s.level_for_target();
    while (s.live.level() != wanted && out.splits < budget.max_splits) {
        const bool finer = wanted > s.live.level();
        const std::size_t distance = finer ? wanted - s.live.level() : s.live.level() - wanted;
        const std::size_t step = std::min({distance, kStride, budget.max_splits - out.splits});
        if (finer)
            s.live.refine(step);
        else
            s.live.coarsen(step);
        out.splits += step;
        if (late()) break;
    }
    const bool all = s.decoded >= s.blocks_for_target();
    out.reached = all && s.live.level() == wanted;
    out.wants_bytes = !all && !stop && !s.lent && !s.broken && !s.whole.contains(s.decoded);
    return out;
}

std::optional<DecodeJob> Stream::take_job() {
    State& s = *state_;
    if (s.broken || !s.decoder) return {};
    const auto at = s.whole.find(s.decoded);
    if (at == s.whole.end()) return {};
    DecodeJob job(*std::move(s.decoder), std::move(at->second), s.decoded);
    s.decoder.reset();
    s.whole.erase(at);
    s.pending_bytes -= s.info->blocks[s.decoded].bytes;
    s.lent = true;
    return job;
}

void DecodeJob::run() {
    assert(!ran_);
    status_ = decoder_.decode(stored_);
    ran_ = true;
}

Status Stream::finish_job(DecodeJob&& job) {
    State& s = *state_;
    assert(s.lent && job.ran_ && job.block_ == s.decoded);
    s.lent = false;
    s.decoder = std::move(job.decoder_);
    if (!job.status_) {
        // The checksum was right: asking again would bring the same bytes.
        return s.fail(job.status_.error(), true);
    }
    ++s.decoded;
    s.live.append(s.decoder->mesh());
    Status planned = Ok{};
    if (s.selective && !(planned = s.selective->append(s.decoder->mesh()))) {
        s.selective.reset();
        s.selective_wanted = false;
    }
    if (s.decoded == s.info->blocks.size()) s.decoder.reset();
    return planned ? planned : Status(s.fail(planned.error(), false));
}

void Stream::jump_to_target() {
    State& s = *state_;
    Updated unused;
    if (s.selective)
        s.update_selective({}, unused);
    else if (ready())
        s.live.jump(s.level_for_target());
}

// ---- The rest

Stream::Stream(StreamOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

void Stream::set_target(Target target) {
    if (!(target.value >= 0)) target.value = 0;
    state_->target = target;
}
Target Stream::target() const {
    return state_->target;
}
const FileInfo* Stream::info() const {
    return state_->info ? &*state_->info : nullptr;
}
bool Stream::ready() const {
    return state_->info &&
           (state_->decoder || state_->lent || state_->decoded == state_->info->blocks.size());
}
bool Stream::broken() const {
    return state_->broken;
}
const std::optional<Error>& Stream::error() const {
    return state_->error;
}
bool Stream::complete() const {
    return ready() && state_->decoded == state_->info->blocks.size();
}
std::uint64_t Stream::bytes_received() const {
    return state_->received;
}
std::size_t Stream::blocks_decoded() const {
    return state_->decoded;
}
float Stream::level_error() const {
    const State& s = *state_;
    if (!s.info) return 0;
    // The live mesh knows the error before each split that has come; after the last one, the table does.
    if (s.live.level() < s.live.available()) return s.live.error_at(s.live.level());
    return s.error_after(s.decoded);
}
const LiveBuffers& Stream::buffers() const {
    return state_->live;
}
LiveBuffers& Stream::buffers() {
    return state_->live;
}

}  // namespace vsplit
