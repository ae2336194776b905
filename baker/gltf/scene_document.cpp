// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "scene_document.hpp"

#include <algorithm>
#include <functional>

#include "accessor.hpp"
#include "buffers.hpp"
#include "container.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// A whole number below `size`, or `size`.
std::size_t number_in(const OrderedJson* value, std::size_t size) {
    if (value == nullptr || !value->is_number()) return size;
    const double number = value->get<double>();
    return number >= 0 && number < double(size) ? std::size_t(number) : size;
}

template <class Each>
void for_each(OrderedJson& object, const char* key, Each each) {
    OrderedJson* array = member(object, key);
    if (array == nullptr || !array->is_array()) return;
    for (std::size_t i = 0; i < array->size(); ++i)
        if ((*array)[i].is_object()) each((*array)[i], i);
}

/// What of accessors and views is only there for the triangles taken out.
class Sweep {
  public:
    Sweep(OrderedJson& root, const TakenPrimitives& taken) : root_(root), taken_(taken) {
        const auto count = [&](const char* key) {
            const OrderedJson* array = member(root_, key);
            return array != nullptr && array->is_array() ? array->size() : 0;
        };
        accessors_.assign(count("accessors"), {});
        views_.assign(count("bufferViews"), {});
    }

    void run() {
        for_each(root_, "meshes", [&](OrderedJson& mesh, std::size_t m) {
            for_each(mesh, "primitives", [&](OrderedJson& primitive, std::size_t p) {
                const bool gone = taken_.contains({m, p});
                const auto mark = [&](OrderedJson& object) {
                    for (auto& [name, number] : object.items()) mark_accessor(&number, gone);
                };
                if (OrderedJson* attributes = member(primitive, "attributes")) mark(*attributes);
                mark_accessor(member(primitive, "indices"), gone);
                for_each(primitive, "targets", [&](OrderedJson& target, std::size_t) { mark(target); });
                if (!gone) return;
                if (const OrderedJson* draco = extension_of(primitive, "KHR_draco_mesh_compression"))
                    mark_view(member(*draco, "bufferView"), true);
                erase_extension(primitive, "KHR_draco_mesh_compression");
                for (const char* key : {"attributes", "indices", "targets", "mode"}) primitive.erase(key);
            });
        });
        for_each(root_, "skins", [&](OrderedJson& skin, std::size_t) {
            mark_accessor(member(skin, "inverseBindMatrices"), false);
        });
        for_each(root_, "animations", [&](OrderedJson& animation, std::size_t) {
            for_each(animation, "samplers", [&](OrderedJson& sampler, std::size_t) {
                mark_accessor(member(sampler, "input"), false);
                mark_accessor(member(sampler, "output"), false);
            });
        });
        for_each(root_, "nodes", [&](OrderedJson& node, std::size_t) {
            if (const OrderedJson* instancing = extension_of(node, "EXT_mesh_gpu_instancing"))
                if (const OrderedJson* attributes = member(*instancing, "attributes"))
                    for (const auto& [name, number] : attributes->items()) mark_accessor(&number, false);
        });
        // Views: through accessors, and wherever else anything calls something "bufferView".
        for_each(root_, "accessors", [&](OrderedJson& accessor, std::size_t a) {
            const bool dead = gone(a);
            mark_view(member(accessor, "bufferView"), dead);
            if (const OrderedJson* sparse = member(accessor, "sparse"))
                for (const char* key : {"indices", "values"})
                    if (const OrderedJson* part = member(*sparse, key))
                        mark_view(member(*part, "bufferView"), dead);
        });
        for (auto& [key, value] : root_.items())
            if (key != "accessors") walk(value);
    }

    bool gone(std::size_t accessor) const { return accessors_[accessor].gone && !accessors_[accessor].stays; }
    bool view_gone(std::size_t view) const { return views_[view].gone && !views_[view].stays; }
    /// Whether triangles that are gone share the view with something that stays.
    bool view_mixed(std::size_t view) const { return views_[view].gone && views_[view].stays; }
    bool view_in_doubt(std::size_t view) const { return views_[view].elsewhere; }

  private:
    struct Mark {
        bool gone = false, stays = false, elsewhere = false;
    };

    void mark_accessor(const OrderedJson* number, bool gone) {
        if (const std::size_t a = number_in(number, accessors_.size()); a < accessors_.size())
            (gone ? accessors_[a].gone : accessors_[a].stays) = true;
    }
    void mark_view(const OrderedJson* number, bool gone) {
        if (const std::size_t v = number_in(number, views_.size()); v < views_.size())
            (gone ? views_[v].gone : views_[v].stays) = true;
    }
    /// As deep as the document, which Document::parse has limited.
    void walk(const OrderedJson& value) {
        if (value.is_object() || value.is_array())
            for (const auto& [key, inner] : value.items()) {
                if (key == "bufferView" && value.is_object()) {
                    mark_view(&inner, false);
                    if (const std::size_t v = number_in(&inner, views_.size()); v < views_.size())
                        views_[v].elsewhere = true;
                }
                walk(inner);
            }
    }

    OrderedJson& root_;
    const TakenPrimitives& taken_;
    std::vector<Mark> accessors_, views_;
};

std::string media_type(Bytes bytes) {
    const auto begins = [&](std::size_t at, std::string_view magic) {
        return bytes.size() >= at + magic.size() &&
               std::equal(magic.begin(), magic.end(), bytes.begin() + std::ptrdiff_t(at),
                          [](char c, std::byte b) { return static_cast<std::byte>(c) == b; });
    };
    if (begins(0, "\x89PNG\r\n\x1A\n")) return "image/png";
    if (begins(0, "\xFF\xD8\xFF")) return "image/jpeg";
    if (begins(0, "RIFF") && begins(8, "WEBP")) return "image/webp";
    if (begins(0, "\xABKTX 20\xBB\r\n\x1A\n")) return "image/ktx2";
    if (begins(4, "ftypavif")) return "image/avif";
    return {};
}

class Remains {
  public:
    Remains(Document& document, const SceneUse& use) : document_(document), use_(use) {}
    SceneDocument out;

    Status take(Bytes file, const std::string& folder, const TakenPrimitives& taken,
                std::vector<std::string>& notes) {
        const auto container = open_container(file);
        if (!container.ok()) return container.error();
        out.root = OrderedJson::parse(container->json);
        drop_levels();
        Sweep sweep(out.root, taken);
        sweep.run();
        if (Status status = keep_views(sweep); !status.ok()) return status;
        for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
            if (!still_there(name)) forget_extension(out.root, name);
        embed_images(folder, notes);
        read_skins();
        out.root.erase("buffers");
        return Ok{};
    }

  private:
    /// Coarser levels that the file brings: their nodes stay, for the numbers' sake, but hold nothing.
    void drop_levels() {
        for_each(out.root, "nodes", [&](OrderedJson& node, std::size_t n) {
            if (extension_of(node, "MSFT_lod") != nullptr) {
                erase_extension(node, "MSFT_lod");
                if (OrderedJson* extras = member(node, "extras"); extras != nullptr && extras->is_object()) {
                    extras->erase("MSFT_screencoverage");
                    if (extras->empty()) node.erase("extras");
                }
            }
            if (use_.only_lod[n] != 0)
                for (const char* key : {"mesh", "skin", "weights"}) node.erase(key);
        });
        bool in_materials = false;
        for_each(out.root, "materials", [&](OrderedJson& material, std::size_t) {
            in_materials = in_materials || extension_of(material, "MSFT_lod") != nullptr;
        });
        if (!in_materials) forget_extension(out.root, "MSFT_lod");
    }

    Status keep_views(const Sweep& sweep) {
        OrderedJson* accessors = member(out.root, "accessors");
        OrderedJson* views = member(out.root, "bufferViews");
        if (accessors != nullptr)
            for (std::size_t a = 0; a < accessors->size(); ++a)
                if (sweep.gone(a)) (*accessors)[a] = nullptr;
        if (views == nullptr) return Ok{};
        // An accessor that stays takes its part of a view that triangles shared, instead of all of it.
        const std::size_t count = views->size();
        std::vector<std::uint8_t> needed(count, 0);
        for (std::size_t v = 0; v < count; ++v)
            needed[v] = !sweep.view_gone(v) && (!sweep.view_mixed(v) || sweep.view_in_doubt(v));
        if (accessors != nullptr)
            for (std::size_t a = 0; a < accessors->size(); ++a) {
                OrderedJson& accessor = (*accessors)[a];
                if (!accessor.is_object()) continue;
                const std::size_t v = number_in(member(accessor, "bufferView"), count);
                if (v < count && needed[v] == 0 &&
                    (accessor.contains("sparse") || !slice(accessor, a, v, *views)))
                    needed[v] = 1;
                if (const OrderedJson* sparse = member(accessor, "sparse"))
                    for (const char* key : {"indices", "values"})
                        if (const OrderedJson* part = member(*sparse, key))
                            if (const std::size_t s = number_in(member(*part, "bufferView"), count);
                                s < count)
                                needed[s] = 1;
            }
        for (std::size_t v = 0; v < count; ++v) {
            if (needed[v] == 0) {
                (*views)[v] = nullptr;
                continue;
            }
            OrderedJson& view = (*views)[v];
            KeptView kept;
            const auto compressed = document_.meshopt.find(v);
            const tinygltf::BufferView& source = document_.model.bufferViews[v];
            const auto bytes =
                compressed != document_.meshopt.end()
                    ? document_.stored(compressed->second.buffer, compressed->second.offset,
                                       compressed->second.length)
                    : document_.stored(std::size_t(source.buffer), source.byteOffset, source.byteLength);
            if (!bytes.ok())
                return fault(bytes.error().code, object_name("bufferViews", v) + " " + bytes.error().message);
            if (compressed != document_.meshopt.end()) kept.decoded_bytes = source.byteLength;
            kept.bytes.assign(bytes->begin(), bytes->end());
            total_ += kept.bytes.size();
            view.erase("buffer");
            view.erase("byteOffset");
            out.views.emplace(v, std::move(kept));
            // Views may overlap; what they hold together is bounded all the same.
            if (total_ > 16 * (document_.total_bytes() + 4096))
                return fault(ErrorCode::kLimit, "the buffer views are sixteen times as long as the buffers");
        }
        return Ok{};
    }

    /// False if the part cannot be told.
    bool slice(OrderedJson& accessor, std::size_t a, std::size_t v, OrderedJson& views) {
        if (document_.meshopt.contains(v) || a >= document_.model.accessors.size()) return false;
        const tinygltf::Accessor& source = document_.model.accessors[a];
        const tinygltf::BufferView& view = document_.model.bufferViews[v];
        const int stride = source.ByteStride(view);
        const int width = tinygltf::GetComponentSizeInBytes(std::uint32_t(source.componentType));
        const int components = tinygltf::GetNumComponentsInType(std::uint32_t(source.type));
        if (stride <= 0 || width <= 0 || components <= 0 || source.count == 0) return false;
        // Padding within matrices of small numbers is left to the whole view.
        if (source.type >= TINYGLTF_TYPE_MAT2 && width < 4) return false;
        const std::uint64_t row = std::uint64_t(width) * std::uint64_t(components);
        if (source.count > document_.total_bytes()) return false;
        const std::uint64_t length = (source.count - 1) * std::uint64_t(stride) + row;
        if (source.byteOffset > view.byteLength || length > view.byteLength - source.byteOffset) return false;
        const auto bytes =
            document_.stored(std::size_t(view.buffer), view.byteOffset + source.byteOffset, length);
        if (!bytes.ok()) return false;
        total_ += length;
        if (total_ > 16 * (document_.total_bytes() + 4096)) return false;
        OrderedJson made = views[v];
        made.erase("buffer");
        made.erase("byteOffset");
        made["byteLength"] = length;
        KeptView kept;
        kept.bytes.assign(bytes->begin(), bytes->end());
        out.views.emplace(views.size(), std::move(kept));
        accessor["bufferView"] = views.size();
        accessor.erase("byteOffset");
        views.push_back(std::move(made));
        return true;
    }

    bool still_there(const char* name) const {
        const std::function<bool(const OrderedJson&)> look = [&](const OrderedJson& value) {
            if (!value.is_object() && !value.is_array()) return false;
            if (value.is_object() && extension_of(value, name) != nullptr) return true;
            return std::any_of(value.begin(), value.end(), look);
        };
        for (const char* key : {"meshes", "bufferViews"})
            if (const OrderedJson* array = member(out.root, key))
                if (look(*array)) return true;
        return false;
    }

    void embed_images(const std::string& folder, std::vector<std::string>& notes) {
        if (!out.root.contains("bufferViews")) out.root["bufferViews"] = OrderedJson::array();
        OrderedJson* views = member(out.root, "bufferViews");
        for_each(out.root, "images", [&](OrderedJson& image, std::size_t i) {
            if (const std::size_t v = number_in(member(image, "bufferView"), views->size());
                v < views->size() && out.views.contains(v))
                out.views.at(v).image = true;
            const OrderedJson* uri = member(image, "uri");
            if (uri == nullptr || !uri->is_string()) return;
            auto bytes = load_uri(uri->get_ref<const std::string&>(), folder);
            const std::string type = bytes.ok() ? media_type(*bytes) : std::string();
            if (!bytes.ok() || type.empty() || bytes->empty()) {
                notes.push_back(object_name("images", i) + " stays outside: " +
                                (bytes.ok() ? "not a kind of picture that is known" : bytes.error().message));
                return;
            }
            const std::size_t number = views->size();
            views->push_back({{"byteLength", bytes->size()}});
            out.views.emplace(number, KeptView{std::move(*bytes), 0, true});
            image.erase("uri");
            image["mimeType"] = type;
            image["bufferView"] = number;
        });
    }

    void read_skins() {
        for (const tinygltf::Skin& skin : document_.model.skins) {
            std::vector<float> matrices(skin.joints.size() * 16, 0.0f);
            Result<AccessorReader> source = Error{};
            if (skin.inverseBindMatrices >= 0)
                source = AccessorReader::open(document_, skin.inverseBindMatrices, "inverseBindMatrices");
            const bool given = source.ok() && source->type() == TINYGLTF_TYPE_MAT4;
            for (std::size_t j = 0; j < skin.joints.size(); ++j) {
                const auto matrix = std::span(matrices).subspan(16 * j, 16);
                if (given && j < source->count())
                    source->read(j, matrix);
                else
                    matrix[0] = matrix[5] = matrix[10] = matrix[15] = 1;
            }
            out.inverse_bind.push_back(std::move(matrices));
        }
    }

    Document& document_;
    const SceneUse& use_;
    std::uint64_t total_ = 0;
};

}  // namespace

const OrderedJson* member(const OrderedJson& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

OrderedJson* member(OrderedJson& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const OrderedJson* extension_of(const OrderedJson& object, const char* name) {
    const OrderedJson* extensions = member(object, "extensions");
    return extensions == nullptr ? nullptr : member(*extensions, name);
}

void erase_extension(OrderedJson& object, const char* name) {
    OrderedJson* extensions = member(object, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return;
    extensions->erase(name);
    if (extensions->empty()) object.erase("extensions");
}

void forget_extension(OrderedJson& root, const char* name) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        OrderedJson* names = member(root, key);
        if (names == nullptr || !names->is_array()) continue;
        OrderedJson kept = OrderedJson::array();
        for (const OrderedJson& item : *names)
            if (item != name) kept.push_back(item);
        *names = std::move(kept);
        if (names->empty()) root.erase(key);
    }
}

void use_extension(OrderedJson& root, const char* name, bool required) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        if (key == std::string_view("extensionsRequired") && !required) continue;
        OrderedJson& names = root[key];
        if (!names.is_array()) names = OrderedJson::array();
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
}

Result<SceneDocument> remaining_document(Bytes file, Document& document, const std::string& folder,
                                         const SceneUse& use, const TakenPrimitives& taken,
                                         std::vector<std::string>& notes) {
    Remains remains(document, use);
    if (Status status = remains.take(file, folder, taken, notes); !status.ok()) return status.error();
    return std::move(remains.out);
}

}  // namespace vsplit::bake
