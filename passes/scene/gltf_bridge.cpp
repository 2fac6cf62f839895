// SPDX-License-Identifier: MIT
#include "gltf_bridge.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <tiny_gltf.h>

// No exception may cross into C.
template <typename F> static fg_status guard(F f) noexcept
{
    try {
        return f();
    } catch (const std::bad_alloc &) {
        return FG_ERR_MEMORY;
    } catch (const std::length_error &) {
        return FG_ERR_MEMORY;
    } catch (...) {
        return FG_ERR_INPUT;
    }
}

// ---- tinygltf's calls back --------------------------------------------------------

// tinygltf looks for "NAME", then for "./NAME"; both come here, and the first fault stays.
static bool file_exists(const std::string &uri, void *user)
{
    auto *files = static_cast<gltf_files *>(user);
    const uint64_t bytes_left = files->bytes_left;
    size_t size = 0;
    const int file = gltf_open_uri(files, uri.c_str(), uri.size(), &size);
    files->bytes_left = bytes_left;
    return file >= 0 && gltf_read_and_close(file, nullptr, 0);
}

static std::string expand_path(const std::string &uri, void *)
{
    return uri;
}

static bool read_file(std::vector<unsigned char> *out, std::string *, const std::string &uri,
                      void *user)
{
    auto *files = static_cast<gltf_files *>(user);
    size_t size = 0;
    const int file = gltf_open_uri(files, uri.c_str(), uri.size(), &size);
    if (file < 0)
        return false;
    try {
        out->resize(size);
    } catch (...) {
        gltf_read_and_close(file, nullptr, 0);
        throw;
    }
    return gltf_read_and_close(file, out->data(), size);
}

static bool write_file(std::string *, const std::string &, const std::vector<unsigned char> &,
                       void *)
{
    return false;
}

// Keeps the encoded file. The bytes of a view are not touched: nobody has checked it yet.
// NOLINTNEXTLINE(readability-function-size): the parameters are tinygltf's
static bool keep_image(tinygltf::Image *image, const int, std::string *, std::string *, int, int,
                       const unsigned char *bytes, int size, void *)
{
    if (image->bufferView < 0 && size > 0)
        image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// ---- faults -----------------------------------------------------------------------

// tinygltf reports what the specification allows to leave out, an animation channel's node and a
// skin's matrices, and goes on.
static bool harmless(const std::string &line)
{
    return line.empty() || line == "'inverseBindMatrices' property is missing in Skin." ||
           line == "'node' property is missing." ||
           line.find("`node` field is missing in animation.channels.target") == 0;
}

// The first line that is a fault, as printable text.
static std::string first_fault(const std::string &text)
{
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        std::string line = text.substr(at, std::min<size_t>(end - at, GLTF_FAULT - 10));
        at = end + 1;
        if (harmless(line))
            continue;
        for (char &c : line)
            c = static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
        return line;
    }
    return "";
}

// Whether tinygltf could parse it; `error` says why not.
static bool parse(const gltf_blob *blob, gltf_files *files, tinygltf::Model *model,
                  std::string *error)
{
    tinygltf::TinyGLTF tiny;
    tiny.SetFsCallbacks({ file_exists, expand_path, read_file, write_file, files });
    tiny.SetImageLoader(keep_image, nullptr);
    const auto size = static_cast<unsigned>(blob->size);
    std::string warning;
    try {
        if (blob->binary)
            return tiny.LoadBinaryFromMemory(model, error, &warning, blob->data, size, "");
        return tiny.LoadASCIIFromString(model, error, &warning,
                                        reinterpret_cast<const char *>(blob->data), size, "");
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &e) { // the JSON library's, of values of another type
        *error = e.what();
        return false;
    }
}

static fg_status refuse(gltf_files *files, const char *format, const std::string &what)
{
    std::snprintf(files->fault, sizeof files->fault, format, what.c_str());
    return FG_ERR_INPUT;
}

fg_status gltf_parse(const gltf_blob *blob, gltf_files *files, gltf_parsed **out,
                     gltf_model *mirror)
{
    *out = nullptr;
    *mirror = {};
    return guard([&] {
        auto model = std::make_unique<tinygltf::Model>();
        std::string error;
        const bool ok = parse(blob, files, model.get(), &error);
        const std::string fault = first_fault(error);
        for (const std::string &name : model->extensionsRequired)
            if (!gltf_extension_known(name.c_str()))
                return refuse(files, "extension '%.64s' is required and not supported", name);
        if (!ok && files->fault[0] != '\0')
            return FG_ERR_INPUT;
        if (!ok || !fault.empty())
            return refuse(files, "glTF: %s", fault.empty() ? "it cannot be parsed" : fault);
        auto *parsed = reinterpret_cast<gltf_parsed *>(model.get());
        gltf_mirror_shapes(parsed, mirror);
        gltf_mirror_looks(parsed, mirror);
        *out = reinterpret_cast<gltf_parsed *>(model.release());
        return FG_OK;
    });
}

void gltf_parsed_destroy(gltf_parsed *parsed)
{
    delete reinterpret_cast<tinygltf::Model *>(parsed);
}
