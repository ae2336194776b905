// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A .pmesh that arrives in pieces, refined and coarsened while it does. No I/O, no threads, no clock: the
// host fetches the bytes that wants() names, hands them to feed(), and calls update() as often as it likes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vsplit/camera.hpp"
#include "vsplit/live_buffers.hpp"
#include "vsplit/read.hpp"
#include "vsplit/result.hpp"
#include "vsplit/view_mesh.hpp"

namespace vsplit {

/// Half-open range of bytes of the file.
struct ByteRange {
    std::uint64_t offset = 0, size = 0;
    friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// How fine the mesh should be.
struct Target {
    enum class Kind : std::uint8_t {
        kRatio,  ///< Triangles over those of the full mesh, 0 to 1: the finest level with at most so many.
        kTriangles,  ///< The finest level with at most so many.
        kVertices,   ///< Likewise.
        kError,      ///< The coarsest level whose geometric error is at most this, in the object's units.
        kPixels,  ///< The same, with an error as error_of_pixels() gives it; small changes are not followed.
    };
    Kind kind = Kind::kRatio;
    double value = 1;
    /// Whatever the kind asks for: never finer than the finest level with at most so many triangles. An error
    /// on the screen and what the machine can draw, in one.
    std::uint64_t max_triangles = ~std::uint64_t{0};

    static Target ratio(double share) { return {Kind::kRatio, share}; }
    static Target triangles(std::uint64_t count) { return {Kind::kTriangles, double(count)}; }
    static Target vertices(std::uint64_t count) { return {Kind::kVertices, double(count)}; }
    static Target error(double distance) { return {Kind::kError, distance}; }
    static Target pixels(double distance) { return {Kind::kPixels, distance}; }
    /// The same with at most so many triangles: Target::pixels(e).at_most(200'000).
    Target at_most(std::uint64_t count) const { return {kind, value, count}; }
};

/// Bounds of one call of Stream::update().
struct Budget {
    std::size_t max_splits = ~std::size_t{0};  ///< Splits applied or undone at most.
    std::size_t max_blocks = ~std::size_t{0};  ///< Blocks decoded at most.
    /// Asked between blocks and every few thousand splits; true ends the call. May be empty.
    std::function<bool()> out_of_time{};
    /// Selective refinement: places looked at, at most; the next call goes on where this one ended.
    std::size_t max_visits = ~std::size_t{0};
};

/// What update() came to.
struct Updated {
    std::size_t splits = 0;    ///< Applied or undone.
    bool reached = false;      ///< The target's level is there.
    bool wants_bytes = false;  ///< More of the file is needed before it can be; see wants().
};

struct StreamOptions {
    Limits limits;
    /// A block (or the front of the file) that fails its checksum is asked for again; so many failures of one
    /// end the stream.
    int tries = 3;
    /// Target kPixels: how much finer than asked a level may be, as a share, before it is coarsened.
    double hysteresis = 0.25;
    /// Bytes of blocks that have come but are not decoded yet, at most; what would exceed it is dropped, and
    /// wanted again. At least one block is held.
    std::uint64_t max_pending_bytes = std::uint64_t{16} << 20;
    BaseMeshDecoder decode_base{};  ///< The host's, in place of Draco.
};

/// One block's decoding as work that any thread may do: it shares nothing with the stream it came from.
class DecodeJob {
  public:
    DecodeJob(DecodeJob&&) noexcept = default;
    DecodeJob& operator=(DecodeJob&&) noexcept = default;
    /// Once, on any thread.
    void run();

  private:
    friend class Stream;
    DecodeJob(BlockDecoder decoder, std::vector<std::byte> stored, std::size_t block)
        : decoder_(std::move(decoder)), stored_(std::move(stored)), block_(block) {}
    BlockDecoder decoder_;
    std::vector<std::byte> stored_;
    std::size_t block_;
    Status status_ = Ok{};
    bool ran_ = false;
};

/// Streams are independent of each other; one stream is for one thread at a time. All bytes are hostile.
class Stream {
  public:
    explicit Stream(StreamOptions options = {});
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) noexcept;
    ~Stream();

    /// Starts at ratio 1.
    void set_target(Target target);
    Target target() const;

    /// The bytes that the target needs next, in the order in which they help, `most_bytes` in all at most
    /// (but one byte at least). Empty if all are there, or the stream is broken. Before the front is known:
    /// the first 16 KiB. Adjacent blocks make one range. `ahead` more blocks than the target needs are named,
    /// too.
    std::vector<ByteRange> wants(std::uint64_t most_bytes = std::uint64_t{1} << 18,
                                 std::size_t ahead = 0) const;

    /// Takes bytes from anywhere in the file, in any sizes and any order, as often as they come: what is not
    /// wanted is passed over, so a server's whole file in answer to a range is fine. Linear in the bytes;
    /// does not decode blocks, but the base mesh when the front is complete. Errors: kChecksum (a block or
    /// the front was damaged; it is wanted again, and the stream goes on unless broken()); kMalformed,
    /// kUnsupported, kLimit, kTruncated (not a file that this reader can read: broken()).
    Status feed(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Tells how long the file is, when a server says so. An Error, and broken(), if that contradicts it.
    Status set_file_size(std::uint64_t bytes);

    /// Null until header and table are known.
    const FileInfo* info() const;
    /// The base mesh is there: something can be drawn.
    bool ready() const;
    /// Nothing more will come of this stream; what was decoded stays drawable. See error().
    bool broken() const;
    /// The last failure, or none.
    const std::optional<Error>& error() const;
    /// All blocks are decoded; wants() is empty for good.
    bool complete() const;
    /// Bytes of the file that were taken.
    std::uint64_t bytes_received() const;
    std::size_t blocks_decoded() const;

    /// Decodes blocks that the target needs, then refines or coarsens towards it. Work is bounded by `budget`
    /// but for one block. Errors as feed(), for a block whose contents lie under an intact checksum:
    /// broken().
    Result<Updated> update(const Budget& budget = {});

    /// Moves the decoding of the next complete block out, for another thread; none if there is none to do.
    /// Until it is given back, update() only moves within what is there.
    std::optional<DecodeJob> take_job();
    Status finish_job(DecodeJob&& job);

    /// Jumps to the target's level at once where that is faster than walking; as update(), without a budget,
    /// within what is decoded.
    void jump_to_target();

    // Selective refinement: finer here, coarser there.

    /// From now on, or no longer, update() refines selective() and leaves buffers() where they are: where
    /// set_view() looks, and without a view towards target() in the order of priorities (ViewMesh::rank()).
    /// May be called at any time; before ready() it is done when that comes. It takes a copy of all splits
    /// decoded and plans them (about two seconds for a million triangles at once, less a block while they
    /// arrive) and keeps about eight times the indexed triangle list beside buffers(). Errors: kLimit, as
    /// ViewMesh::make(): it stays off. If splits that come later are too many, update() gives that Error, and
    /// it is off from then on.
    Status set_selective(bool on);
    /// Null if it is off, and before ready(). Priorities are set here. Its vertex arrays stay where they are.
    const ViewMesh* selective() const;
    ViewMesh* selective();
    /// What the camera sees is refined, the rest kept coarse. wants() names what the nearest place of the
    /// object's box may need, and nothing while the box is out of view. target() does not count meanwhile.
    void set_view(const CameraView& view);
    void clear_view();

    /// Geometric error of the level that is there, in the object's units; that of the base mesh before
    /// ready().
    float level_error() const;

    /// What to draw, unless selective() is not null. Empty before ready(). Pointers stay the same once
    /// ready().
    const LiveBuffers& buffers() const;
    LiveBuffers& buffers();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace vsplit
