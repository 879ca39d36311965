// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/alembic_shown.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {
namespace {

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxObjects = 1'000'000;

class Finder {
  public:
    Finder(const AlembicArchive& archive, std::span<const std::string_view> schemas)
        : archive_(archive), schemas_(schemas) {}

    Result<AlembicShown> find() {
        if (auto status = visit(archive_.top(), {}, 0); !status) return tl::unexpected(status.error());
        return std::move(found_);
    }

  private:
    Status visit(const AlembicObject& object, AlembicInherited inherited, int depth) {
        if (depth > kMaxDepth)
            return fail(object.path + " lies too deep", fmt::format("expected {} levels", kMaxDepth));
        if (++objects_ > kMaxObjects)
            return fail("its objects and their instances are too many",
                        fmt::format("expected at most {}", kMaxObjects));
        const auto properties = archive_.properties(object);
        if (!properties) return tl::unexpected(properties.error());
        if (valueOf(object.metadata, "isInstance") == "1") {
            if (const AlembicProperty* const source = findProperty(*properties, ".instanceSource"))
                return visitSource(object, *source, std::move(inherited), depth);
        }
        if (auto status = takeVisibility(*properties, inherited); !status) return status;
        if (const AlembicProperty* const xform = findProperty(*properties, ".xform")) {
            if (auto status = addLevel(archive_, object, *xform, inherited.levels); !status) return status;
            takeOfObjects(inherited.levels.back().xform, inherited);
        }
        const AlembicProperty* const geometry = findProperty(*properties, ".geom");
        const std::string schema = geometry == nullptr ? std::string() : schemaOf(object, *geometry);
        if (!schema.empty()) {
            if (inherited.isHidden) {
                found_.hidden.push_back(object.path);
            } else {
                auto inside = archive_.properties(*geometry);
                if (!inside) return tl::unexpected(inside.error());
                found_.objects.push_back({object.path, object.node, schema, std::move(*inside), inherited});
            }
        }
        const auto children = archive_.children(object);
        if (!children) return tl::unexpected(children.error());
        for (const AlembicObject& child : *children) {
            if (auto status = visit(child, inherited, depth + 1); !status) return status;
        }
        return {};
    }

    /// The schema that is looked for; empty where it is another one.
    std::string schemaOf(const AlembicObject& object, const AlembicProperty& geometry) const {
        for (const AlembicMetadata* const metadata : {&object.metadata, &geometry.metadata}) {
            const std::string schema = valueOf(*metadata, "schema");
            const auto isIt = [&](std::string_view beginning) { return schema.starts_with(beginning); };
            if (std::ranges::any_of(schemas_, isIt)) return schema;
        }
        return {};
    }

    /// What an instance stands for, in its place.
    Status visitSource(const AlembicObject& instance, const AlembicProperty& named,
                       AlembicInherited inherited, int depth) {
        const auto path = archive_.text(named, 0);
        if (!path) return tl::unexpected(path.error());
        auto source = archive_.objectAt(*path);
        if (!source) return tl::unexpected(source.error());
        source->path = instance.path;
        return visit(*source, std::move(inherited), depth + 1);
    }

    /// An object that says nothing of it is as visible as the one above.
    Status takeVisibility(const std::vector<AlembicProperty>& properties, AlembicInherited& inherited) {
        const AlembicProperty* const visible = findProperty(properties, "visible");
        if (visible == nullptr || visible->kind != AlembicProperty::Kind::Scalar || visible->samples == 0)
            return {};
        const auto value = archive_.integers(*visible, 0);
        if (!value) return tl::unexpected(value.error());
        enum { kDeferred = -1, kHidden = 0 };
        if (!value->empty() && value->front() != kDeferred) inherited.isHidden = value->front() == kHidden;
        if (visible->moves())
            found_.warnings.push_back(
                fileNote("visibility changes in time; that of the first time was taken", visible->name));
        return {};
    }

    /// Blender keeps the custom properties of an object with its transform, which stands above the curves.
    void takeOfObjects(const std::vector<AlembicProperty>& xform, AlembicInherited& inherited) {
        for (const char* name : {".arbGeomParams", ".userProperties"}) {
            const AlembicProperty* const compound = findProperty(xform, name);
            if (compound == nullptr || compound->kind != AlembicProperty::Kind::Compound) continue;
            const auto inside = archive_.properties(*compound);
            if (!inside) continue;
            for (const AlembicProperty& property : *inside) {
                if (isOfHair(property)) inherited.ofObjects.insert_or_assign(property.name, property);
            }
        }
    }

    const AlembicArchive& archive_;
    std::span<const std::string_view> schemas_;
    AlembicShown found_;
    std::size_t objects_ = 0;
};

}  // namespace

Result<AlembicShown> shownObjects(const AlembicArchive& archive, std::span<const std::string_view> schemas) {
    return Finder(archive, schemas).find();
}

std::string valueOf(const AlembicMetadata& metadata, std::string_view key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
}

bool isOfHair(const AlembicProperty& property) {
    return property.name.starts_with("groom_") && !property.name.ends_with("_AbcGeomScope");
}

}  // namespace hairloom
