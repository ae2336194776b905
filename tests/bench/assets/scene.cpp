// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

namespace vsplit::bench {
namespace {

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix times(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    return c;
}

Matrix composed(const std::vector<double>& t, const std::vector<double>& r, const std::vector<double>& s) {
    const double x = r[0], y = r[1], z = r[2], w = r[3];
    return {s[0] * (1 - 2 * (y * y + z * z)),
            s[0] * 2 * (x * y + z * w),
            s[0] * 2 * (x * z - y * w),
            0,
            s[1] * 2 * (x * y - z * w),
            s[1] * (1 - 2 * (x * x + z * z)),
            s[1] * 2 * (y * z + x * w),
            0,
            s[2] * 2 * (x * z + y * w),
            s[2] * 2 * (y * z - x * w),
            s[2] * (1 - 2 * (x * x + y * y)),
            0,
            t[0],
            t[1],
            t[2],
            1};
}

/// Numbers of an accessor, row by row, sparse ones included.
std::vector<double> numbers(const tinygltf::Model& model, int number, std::size_t width) {
    const tinygltf::Accessor& a = model.accessors.at(std::size_t(number));
    const auto own = std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(a.type)));
    const auto read = [&](const unsigned char* p, int type, bool normalized) {
        const auto as = [&](auto value, double most) {
            std::memcpy(&value, p, sizeof value);
            return normalized ? std::max(-1.0, double(value) / most) : double(value);
        };
        switch (type) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return as(std::int8_t{}, 127);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return as(std::uint8_t{}, 255);
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return as(std::int16_t{}, 32767);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return as(std::uint16_t{}, 65535);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return as(std::uint32_t{}, 1);
            default:
                return as(float{}, 1);
        }
    };
    const auto begin = [&](int view, std::size_t offset) {
        const tinygltf::BufferView& v = model.bufferViews.at(std::size_t(view));
        return model.buffers.at(std::size_t(v.buffer)).data.data() + v.byteOffset + offset;
    };
    const auto size = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(a.componentType)));
    std::vector<double> out(a.count * width, 0.0);
    if (a.bufferView >= 0) {
        const tinygltf::BufferView& v = model.bufferViews.at(std::size_t(a.bufferView));
        const auto stride = std::size_t(a.ByteStride(v));
        if (a.count > 0 && v.byteOffset + a.byteOffset + stride * (a.count - 1) + size * own >
                               model.buffers.at(std::size_t(v.buffer)).data.size())
            throw std::runtime_error("an accessor reaches beyond its buffer");
        const unsigned char* p = begin(a.bufferView, a.byteOffset);
        for (std::size_t i = 0; i < a.count; ++i)
            for (std::size_t k = 0; k < std::min(own, width); ++k)
                out[width * i + k] = read(p + stride * i + size * k, a.componentType, a.normalized);
    }
    if (a.sparse.isSparse) {
        const unsigned char* at =
            begin(a.sparse.indices.bufferView, std::size_t(a.sparse.indices.byteOffset));
        const unsigned char* p = begin(a.sparse.values.bufferView, std::size_t(a.sparse.values.byteOffset));
        const auto step =
            std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(a.sparse.indices.componentType)));
        for (std::size_t n = 0; n < std::size_t(a.sparse.count); ++n) {
            std::uint32_t i = 0;
            std::memcpy(&i, at + step * n, step);
            for (std::size_t k = 0; k < std::min(own, width); ++k)
                out.at(width * i + k) = read(p + size * (own * n + k), a.componentType, a.normalized);
        }
    }
    return out;
}

template <class Row>
std::vector<Row> rows(const tinygltf::Model& model, int accessor) {
    constexpr std::size_t width = std::tuple_size_v<Row>;
    const auto values = numbers(model, accessor, width);
    std::vector<Row> out(values.size() / width);
    for (std::size_t i = 0; i < values.size(); ++i)
        out[i / width][i % width] = typename Row::value_type(values[i]);
    return out;
}

Texture make_texture(const tinygltf::Image& image) {
    Texture out;
    if (image.width <= 0 || image.height <= 0 || image.bits != 8 || image.component != 4) return out;
    Texture::Level level{image.width, image.height, {}};
    level.pixels.resize(std::size_t(image.width) * std::size_t(image.height));
    for (std::size_t i = 0; i < level.pixels.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) level.pixels[i][k] = float(image.image[4 * i + k]) / 255;
    out.levels.push_back(std::move(level));
    while (out.levels.back().width > 1 || out.levels.back().height > 1) {
        const Texture::Level& from = out.levels.back();
        Texture::Level half{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x) {
                Vec4 sum{};
                for (const int dy : {0, 1})
                    for (const int dx : {0, 1}) {
                        const int sx = std::min(2 * x + dx, from.width - 1),
                                  sy = std::min(2 * y + dy, from.height - 1);
                        for (std::size_t k = 0; k < 4; ++k)
                            sum[k] += from.pixels[std::size_t(sy * from.width + sx)][k] / 4;
                    }
                half.pixels.push_back(sum);
            }
        out.levels.push_back(std::move(half));
    }
    return out;
}

Primitive read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& from) {
    Primitive out;
    const auto has = [&](const char* name) { return from.attributes.count(name) != 0; };
    out.positions = rows<Vec3>(model, from.attributes.at("POSITION"));
    if (has("NORMAL")) out.normals = rows<Vec3>(model, from.attributes.at("NORMAL"));
    if (has("TEXCOORD_0")) out.uvs = rows<Vec2>(model, from.attributes.at("TEXCOORD_0"));
    if (has("COLOR_0")) {
        out.colors = rows<Vec4>(model, from.attributes.at("COLOR_0"));
        if (model.accessors[std::size_t(from.attributes.at("COLOR_0"))].type == TINYGLTF_TYPE_VEC3)
            for (Vec4& c : out.colors) c[3] = 1;
    }
    for (std::size_t set = 0; set < 2; ++set) {
        const std::string joints = "JOINTS_" + std::to_string(set),
                          weights = "WEIGHTS_" + std::to_string(set);
        if (!has(joints.c_str()) || !has(weights.c_str())) continue;
        const auto j = rows<Vec4>(model, from.attributes.at(joints)),
                   w = rows<Vec4>(model, from.attributes.at(weights));
        out.joints.resize(j.size());
        out.weights.resize(j.size());
        for (std::size_t i = 0; i < j.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                out.joints[i][4 * set + k] = std::uint32_t(j[i][k]);
                out.weights[i][4 * set + k] = w.at(i)[k];
            }
    }
    // Viewers do so; CesiumMan's do not sum to 1.
    for (auto& row : out.weights) {
        float sum = 0;
        for (const float w : row) sum += w;
        for (float& w : row) w = sum > 0 ? w / sum : 0;
    }
    for (const auto& target : from.targets)
        out.morphs.push_back(target.count("POSITION") ? rows<Vec3>(model, target.at("POSITION"))
                                                      : std::vector<Vec3>(out.positions.size()));
    std::vector<std::uint32_t> corners;
    if (from.indices >= 0) {
        for (const double i : numbers(model, from.indices, 1)) corners.push_back(std::uint32_t(i));
    } else {
        for (std::uint32_t i = 0; i < out.positions.size(); ++i) corners.push_back(i);
    }
    const bool strip = from.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
               fan = from.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    for (std::size_t i = 0; i + 2 < corners.size(); i += strip || fan ? 1 : 3) {
        std::array<std::uint32_t, 3> t{corners[fan ? 0 : i], corners[i + 1], corners[i + 2]};
        if (strip && i % 2 != 0) std::swap(t[0], t[1]);
        for (const std::uint32_t v : t)
            if (v >= out.positions.size()) throw std::runtime_error("an index beyond the vertices");
        out.indices.insert(out.indices.end(), t.begin(), t.end());
    }
    out.material = from.material;
    out.weld();
    return out;
}

/// Values of a sampler at a time; of cubic splines the middle ones, linearly.
std::vector<double> sample(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler,
                           double time, bool rotation) {
    const auto times = numbers(model, sampler.input, 1);
    const auto kind = std::uint32_t(model.accessors.at(std::size_t(sampler.output)).type);
    const auto width = std::size_t(tinygltf::GetNumComponentsInType(kind));
    const auto values = numbers(model, sampler.output, width);
    const std::size_t cubic = sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
    const std::size_t row = values.size() / times.size() / cubic;
    const auto at = [&](std::size_t key) {
        const auto begin = values.begin() + std::ptrdiff_t(row * (cubic * key + (cubic == 3 ? 1 : 0)));
        return std::vector<double>(begin, begin + std::ptrdiff_t(row));
    };
    const auto next = std::size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (next == 0) return at(0);
    if (next == times.size()) return at(times.size() - 1);
    auto a = at(next - 1), b = at(next);
    if (sampler.interpolation == "STEP") return a;
    const double t = (time - times[next - 1]) / (times[next] - times[next - 1]);
    double product = 0;
    for (std::size_t i = 0; i < row; ++i) product += a[i] * b[i];
    for (std::size_t i = 0; i < row; ++i) a[i] += t * ((rotation && product < 0 ? -b[i] : b[i]) - a[i]);
    if (rotation) {
        double n = 0;
        for (const double x : a) n += x * x;
        for (double& x : a) x /= std::sqrt(n);
    }
    return a;
}

}  // namespace

Vec4 Texture::at(float u, float v, float level) const {
    if (levels.empty()) return {1, 1, 1, 1};
    const float top = float(levels.size() - 1), l = std::clamp(level, 0.0f, top);
    const auto low = std::size_t(l);
    const auto smooth = [&](const Level& from) {
        const float x = (u - std::floor(u)) * float(from.width) - 0.5f,
                    y = (v - std::floor(v)) * float(from.height) - 0.5f;
        const float fx = x - std::floor(x), fy = y - std::floor(y);
        const auto texel = [&](float px, float py) -> const Vec4& {
            const int ix = (int(std::floor(px)) + from.width) % from.width,
                      iy = (int(std::floor(py)) + from.height) % from.height;
            return from.pixels[std::size_t(iy * from.width + ix)];
        };
        const Vec4 &a = texel(x, y), &b = texel(x + 1, y), &c = texel(x, y + 1), &d = texel(x + 1, y + 1);
        Vec4 out;
        for (std::size_t k = 0; k < 4; ++k)
            out[k] = (a[k] * (1 - fx) + b[k] * fx) * (1 - fy) + (c[k] * (1 - fx) + d[k] * fx) * fy;
        return out;
    };
    Vec4 out = smooth(levels[low]);
    const float between = l - float(low);
    if (between > 0) {
        const Vec4 coarse = smooth(levels[low + 1]);
        for (std::size_t k = 0; k < 4; ++k) out[k] += between * (coarse[k] - out[k]);
    }
    return out;
}

void Primitive::weld() {
    std::map<std::vector<float>, std::uint32_t> known;
    std::vector<std::uint32_t> to(positions.size());
    std::uint32_t count = 0;
    std::vector<float> key;
    const auto add = [&](const auto& array, std::size_t i) {
        if (!array.empty())
            for (const auto x : array[i]) key.push_back(float(x));
    };
    const auto keep = [&](auto& array, std::size_t i) {
        if (!array.empty()) array[count] = array[i];
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
        key.clear();
        add(positions, i), add(normals, i), add(uvs, i), add(colors, i), add(joints, i), add(weights, i);
        for (const auto& morph : morphs) add(morph, i);
        const auto [at, is_new] = known.try_emplace(key, count);
        to[i] = at->second;
        if (!is_new) continue;
        keep(positions, i), keep(normals, i), keep(uvs, i), keep(colors, i), keep(joints, i),
            keep(weights, i);
        for (auto& morph : morphs) keep(morph, i);
        ++count;
    }
    const auto cut = [&](auto& array) {
        if (!array.empty()) array.resize(count);
    };
    cut(positions), cut(normals), cut(uvs), cut(colors), cut(joints), cut(weights);
    for (auto& morph : morphs) cut(morph);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = to[indices[i]], b = to[indices[i + 1]], c = to[indices[i + 2]];
        if (a != b && b != c && c != a) kept.insert(kept.end(), {a, b, c});
    }
    indices = std::move(kept);
}

std::size_t Scene::triangles() const {
    std::size_t sum = 0;
    for (const Primitive& p : primitives) sum += p.indices.size() / 3;
    return sum;
}

Scene load_scene(const std::string& path, double time) {
    tinygltf::Model model;
    tinygltf::TinyGLTF loader;
    std::string error, warning;
    if (!loader.LoadBinaryFromFile(&model, &error, &warning, path))
        throw std::runtime_error(path + ": " + error);
    Scene scene;
    for (const auto& texture : model.textures)
        scene.textures.push_back(texture.source >= 0 ? make_texture(model.images[std::size_t(texture.source)])
                                                     : Texture{});
    for (const auto& from : model.materials) {
        Material material;
        const auto& pbr = from.pbrMetallicRoughness;
        for (std::size_t k = 0; k < 4; ++k) material.factor[k] = float(pbr.baseColorFactor.at(k));
        material.texture = pbr.baseColorTexture.index;
        material.cutout = from.alphaMode == "MASK";
        material.cutoff = float(from.alphaCutoff);
        scene.materials.push_back(material);
    }
    std::vector<std::pair<std::size_t, std::size_t>> meshes;
    for (const auto& mesh : model.meshes) {
        const std::size_t first = scene.primitives.size();
        for (const auto& primitive : mesh.primitives)
            if (primitive.mode == -1 || primitive.mode >= TINYGLTF_MODE_TRIANGLES)
                scene.primitives.push_back(read_primitive(model, primitive));
        meshes.emplace_back(first, scene.primitives.size() - first);
    }

    std::vector<tinygltf::Node> nodes = model.nodes;
    if (!model.animations.empty()) {
        const tinygltf::Animation& animation = model.animations[0];
        double length = 0;
        for (const auto& sampler : animation.samplers)
            for (const double t : numbers(model, sampler.input, 1)) length = std::max(length, t);
        for (const auto& channel : animation.channels) {
            if (channel.target_node < 0) continue;
            tinygltf::Node& node = nodes.at(std::size_t(channel.target_node));
            const auto values = sample(model, animation.samplers.at(std::size_t(channel.sampler)),
                                       time * length, channel.target_path == "rotation");
            if (channel.target_path == "translation") node.translation = values;
            if (channel.target_path == "rotation") node.rotation = values;
            if (channel.target_path == "scale") node.scale = values;
            if (channel.target_path == "weights") node.weights = values;
        }
    }
    std::vector<Matrix> worlds(nodes.size(), kIdentity);
    std::vector<bool> shown(nodes.size(), false);
    const auto visit = [&](const auto& self, int number, const Matrix& parent) -> void {
        const tinygltf::Node& node = nodes.at(std::size_t(number));
        Matrix local;
        if (node.matrix.size() == 16)
            std::copy(node.matrix.begin(), node.matrix.end(), local.begin());
        else
            local = composed(node.translation.empty() ? std::vector<double>{0, 0, 0} : node.translation,
                             node.rotation.empty() ? std::vector<double>{0, 0, 0, 1} : node.rotation,
                             node.scale.empty() ? std::vector<double>{1, 1, 1} : node.scale);
        worlds[std::size_t(number)] = times(parent, local);
        shown[std::size_t(number)] = true;
        for (const int child : node.children) self(self, child, worlds[std::size_t(number)]);
    };
    if (model.scenes.empty()) throw std::runtime_error(path + ": no scene");
    for (const int root : model.scenes[std::size_t(std::max(0, model.defaultScene))].nodes)
        visit(visit, root, kIdentity);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!shown[i] || nodes[i].mesh < 0) continue;
        const auto mesh = std::size_t(nodes[i].mesh);
        Instance instance{meshes.at(mesh).first, meshes.at(mesh).second, worlds[i], {}, {}};
        instance.weights = nodes[i].weights.empty() ? model.meshes[mesh].weights : nodes[i].weights;
        if (nodes[i].skin >= 0) {
            const tinygltf::Skin& skin = model.skins.at(std::size_t(nodes[i].skin));
            const auto inverse = skin.inverseBindMatrices >= 0 ? numbers(model, skin.inverseBindMatrices, 16)
                                                               : std::vector<double>{};
            for (std::size_t j = 0; j < skin.joints.size(); ++j) {
                Matrix bind = kIdentity;
                if (!inverse.empty()) std::copy_n(inverse.begin() + std::ptrdiff_t(16 * j), 16, bind.begin());
                instance.joints.push_back(times(worlds.at(std::size_t(skin.joints[j])), bind));
            }
        }
        scene.instances.push_back(std::move(instance));
    }
    return scene;
}

Soup pose(const Scene& scene) {
    Soup soup;
    for (const Instance& instance : scene.instances)
        for (std::size_t n = instance.first; n < instance.first + instance.count; ++n) {
            const Primitive& p = scene.primitives[n];
            std::vector<Soup::Vertex> vertices(p.positions.size());
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                std::array<double, 3> place{p.positions[i][0], p.positions[i][1], p.positions[i][2]};
                for (std::size_t m = 0; m < std::min(p.morphs.size(), instance.weights.size()); ++m)
                    for (std::size_t k = 0; k < 3; ++k)
                        place[k] += instance.weights[m] * double(p.morphs[m][i][k]);
                Matrix matrix = instance.world;
                if (!instance.joints.empty() && !p.joints.empty()) {
                    matrix = {};
                    for (std::size_t k = 0; k < 8; ++k)
                        if (p.weights[i][k] > 0)
                            for (std::size_t e = 0; e < 16; ++e)
                                matrix[e] += double(p.weights[i][k]) * instance.joints.at(p.joints[i][k])[e];
                }
                Soup::Vertex& v = vertices[i];
                for (std::size_t r = 0; r < 3; ++r)
                    v.position[r] = float(matrix[r] * place[0] + matrix[4 + r] * place[1] +
                                          matrix[8 + r] * place[2] + matrix[12 + r]);
                if (!p.normals.empty()) {
                    // By the cofactors, which turn as areas do.
                    const Vec3& normal = p.normals[i];
                    const auto m = [&](std::size_t r, std::size_t c) { return matrix[4 * (c % 3) + r % 3]; };
                    for (std::size_t r = 0; r < 3; ++r) {
                        double sum = 0;
                        for (std::size_t c = 0; c < 3; ++c)
                            sum += (m(r + 1, c + 1) * m(r + 2, c + 2) - m(r + 1, c + 2) * m(r + 2, c + 1)) *
                                   double(normal[c]);
                        v.normal[r] = float(sum);
                    }
                }
                v.uv = p.uvs.empty() ? Vec2{} : p.uvs[i];
                v.color = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
            }
            for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
                Soup::Vertex t[3] = {vertices[p.indices[i]], vertices[p.indices[i + 1]],
                                     vertices[p.indices[i + 2]]};
                if (p.normals.empty()) {
                    Vec3 e[2], normal;
                    for (std::size_t k = 0; k < 3; ++k) {
                        e[0][k] = t[1].position[k] - t[0].position[k];
                        e[1][k] = t[2].position[k] - t[0].position[k];
                    }
                    for (std::size_t k = 0; k < 3; ++k)
                        normal[k] =
                            e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
                    for (auto& corner : t) corner.normal = normal;
                }
                soup.corners.insert(soup.corners.end(), t, t + 3);
                soup.materials.push_back(p.material);
            }
        }
    return soup;
}

}  // namespace vsplit::bench
