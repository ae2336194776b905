// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The binary adaptive range coder that blocks are written with (Martin, Range Encoding, 1979; the carry as in
// LZMA). Encoder and decoder answer the same calls, so that a model is written once for both: each call takes
// the value to write, which the decoder ignores, and gives back the value that the stream now holds.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// The coder's smallest steps: compilers that leave them out of line lose a fifth of the time.
#if defined(__GNUC__) || defined(__clang__)
#define VSPLIT_INLINE [[gnu::always_inline]] inline
#else
#define VSPLIT_INLINE inline
#endif

namespace vsplit {

/// The rate at which a model that has seen n bits learns from the next: about 1 / (n + 1.5), in 1/65536.
inline constexpr std::uint32_t kLearningSteps = 256;
inline constexpr std::array<std::uint16_t, kLearningSteps> kLearningRates = [] {
    std::array<std::uint16_t, kLearningSteps> rates{};
    for (std::uint32_t n = 0; n < kLearningSteps; ++n)
        rates[n] = static_cast<std::uint16_t>(131072u / (2 * n + 3));
    return rates;
}();

/// How likely the next bit of one kind is 1, learnt from the last `Memory` before it or so.
template <std::uint32_t Memory>
class LearningBit {
  public:
    static_assert(Memory <= kLearningSteps);
    LearningBit() = default;
    /// A prior: the probability of 1 in 1/65536, as if `seen` bits had said so.
    LearningBit(std::uint32_t one, std::uint32_t seen)
        : one_(static_cast<std::uint16_t>(one)), seen_(static_cast<std::uint16_t>(seen)) {}

    /// In 1/65536, kept where neither bit is impossible.
    std::uint32_t one() const { return one_; }
    VSPLIT_INLINE void learn(bool bit) {
        const std::uint32_t rate = kLearningRates[seen_];
        if (seen_ + 1u < Memory) ++seen_;
        if (bit)
            one_ = static_cast<std::uint16_t>(one_ + (((65535u - kLeast - one_) * rate) >> 16));
        else
            one_ = static_cast<std::uint16_t>(one_ - (((one_ - kLeast) * rate) >> 16));
    }

  private:
    static constexpr std::uint32_t kLeast = 24;
    std::uint16_t one_ = 32768, seen_ = 0;
};
/// What changes as a mesh is refined, and what hardly does.
using BitModel = LearningBit<64>;
using SteadyBit = LearningBit<256>;

/// So many zeros may be missing at the end of a stream.
inline constexpr std::size_t kStreamTail = 4;

class RangeEncoder {
  public:
    static constexpr bool kDecodes = false, kWrites = true;

    template <class Model>
    VSPLIT_INLINE bool bit(Model& model, bool value) {
        weighed(model.one(), value);
        model.learn(value);
        return value;
    }
    /// A bit that is 1 with this probability in 1/65536, 1 to 65535.
    VSPLIT_INLINE bool weighed(std::uint32_t one, bool value) {
        const std::uint32_t ones = static_cast<std::uint32_t>((std::uint64_t{range_} * one) >> 16);
        if (value) {
            range_ = ones;
        } else {
            low_ += ones;
            range_ -= ones;
        }
        normalise();
        return value;
    }

    /// `count` bits without a model, 0 to 32.
    std::uint32_t raw(std::uint32_t count, std::uint32_t value) {
        for (; count > 16; count -= 16) raw_few(16, (value >> (count - 16)) & 0xFFFFu);
        if (count > 0) raw_few(count, value & ((1u << count) - 1));
        return value;
    }

    /// One of several, each as likely as its weight says: point() with the weights' sum, at most 2^22, then
    /// take() with the weight of the one at that point and the sum of those before it.
    std::uint32_t point(std::uint32_t) { return 0; }
    void take(std::uint32_t before, std::uint32_t weight, std::uint32_t sum) {
        const std::uint32_t unit = range_ / sum;
        low_ += std::uint64_t{unit} * before;
        range_ = unit * weight;
        normalise();
    }

    /// Ends the stream and gives its bytes away; the encoder begins another. Of the numbers that would do,
    /// the one that ends with the most zeros is written, and zeros are left to the decoder.
    std::vector<std::byte> finish() {
        low_ = (low_ + 0xFFFFFFu) & ~std::uint64_t{0xFFFFFFu};
        for (int i = 0; i < 5; ++i) shift();
        std::vector<std::byte> out = std::move(bytes_);
        for (std::size_t i = 0; i < kStreamTail && out.back() == std::byte{0}; ++i) out.pop_back();
        *this = {};
        return out;
    }

    std::size_t size() const { return bytes_.size() + pending_ + 4; }
    bool overrun() const { return false; }

  private:
    void raw_few(std::uint32_t count, std::uint32_t value) {
        range_ >>= count;
        low_ += std::uint64_t{range_} * value;
        normalise();
    }
    VSPLIT_INLINE void normalise() {
        while (range_ < (1u << 24)) {
            range_ <<= 8;
            shift();
        }
    }
    /// The top byte goes out as soon as no carry can reach it any more.
    void shift() {
        if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
            const auto carry = static_cast<std::uint8_t>(low_ >> 32);
            if (!first_) bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(held_ + carry)));
            first_ = false;
            for (; pending_ > 0; --pending_)
                bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(0xFF + carry)));
            held_ = static_cast<std::uint8_t>(low_ >> 24);
        } else {
            ++pending_;
        }
        low_ = (low_ & 0x00FFFFFFu) << 8;
    }

    std::vector<std::byte> bytes_;
    std::uint64_t low_ = 0;
    std::uint32_t range_ = 0xFFFFFFFFu;
    std::size_t pending_ = 0;
    std::uint8_t held_ = 0;
    bool first_ = true;  // the first byte is always 0 and not stored
};

/// Takes the encoder's part and writes nothing, for a pass that only looks.
struct NoCoder {
    static constexpr bool kDecodes = false, kWrites = false;
    template <class Model>
    bool bit(Model&, bool value) {
        return value;
    }
    bool weighed(std::uint32_t, bool value) { return value; }
    std::uint32_t raw(std::uint32_t, std::uint32_t value) { return value; }
    std::uint32_t point(std::uint32_t) { return 0; }
    void take(std::uint32_t, std::uint32_t, std::uint32_t) {}
    bool overrun() const { return false; }
};

/// Safe for any bytes: behind their end follow zeros, and overrun() says when they are too many.
class RangeDecoder {
  public:
    static constexpr bool kDecodes = true, kWrites = false;

    RangeDecoder() = default;
    explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | next();
    }

    template <class Model>
    VSPLIT_INLINE bool bit(Model& model, bool = false) {
        const bool value = weighed(model.one());
        model.learn(value);
        return value;
    }
    VSPLIT_INLINE bool weighed(std::uint32_t one, bool = false) {
        const std::uint32_t ones = static_cast<std::uint32_t>((std::uint64_t{range_} * one) >> 16);
        const bool value = code_ < ones;
        if (value) {
            range_ = ones;
        } else {
            code_ -= ones;
            range_ -= ones;
        }
        normalise();
        return value;
    }

    VSPLIT_INLINE std::uint32_t raw(std::uint32_t count, std::uint32_t = 0) {
        std::uint32_t value = 0;
        for (; count > 16; count -= 16) value = (value << 16) | raw_few(16);
        if (count > 0) value = (value << count) | raw_few(count);
        return value;
    }

    /// Below `sum`.
    std::uint32_t point(std::uint32_t sum) {
        unit_ = range_ / sum;
        const std::uint32_t at = code_ / unit_;
        return at < sum ? at : sum - 1;  // only a forged stream comes here
    }
    void take(std::uint32_t before, std::uint32_t weight, std::uint32_t) {
        code_ -= unit_ * before;
        range_ = unit_ * weight;
        if (code_ >= range_) code_ = range_ - 1;  // only a forged stream comes here
        normalise();
    }

    /// Bytes taken so far, zeros behind the end among them.
    std::size_t taken() const { return taken_; }
    bool overrun() const { return taken_ > bytes_.size() + kStreamTail; }

  private:
    VSPLIT_INLINE std::uint32_t raw_few(std::uint32_t count) {
        range_ >>= count;
        std::uint32_t value = code_ / range_;
        if (value >> count) value = (1u << count) - 1;  // only a forged stream comes here
        code_ -= range_ * value;
        if (code_ >= range_) code_ = range_ - 1;
        normalise();
        return value;
    }
    std::uint32_t next() {
        const std::size_t at = taken_++;
        return at < bytes_.size() ? static_cast<std::uint32_t>(bytes_[at]) : 0;
    }
    VSPLIT_INLINE void normalise() {
        while (range_ < (1u << 24)) {
            range_ <<= 8;
            code_ = (code_ << 8) | next();
        }
    }

    std::span<const std::byte> bytes_;
    std::uint32_t range_ = 0xFFFFFFFFu, code_ = 0, unit_ = 0;
    std::size_t taken_ = 0;
};

}  // namespace vsplit
