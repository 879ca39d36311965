// SPDX-License-Identifier: GPL-3.0-or-later
#include "hair_object.h"

#include <OgreBone.h>
#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreSceneNode.h>
#include <OgreSkeletonInstance.h>
#include <OgreTechnique.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

using namespace Ogre;

namespace {

/// An asset begins at a multiple of 16 bytes.
struct alignas(16) Piece {
    unsigned char bytes[16];
};

void require(bool good, const std::string& file, const hl_error& error) {
    if (!good) throw std::runtime_error(file + ": " + error.words);
}

Vector3 colourOf(const hl_asset* asset, const char* name, const Vector3& missing) {
    double rgb[3];
    std::size_t count = 0;
    if (hl_asset_numbers(asset, name, rgb, 3, &count, nullptr) != HL_OK || count != 3) return missing;
    return {static_cast<Real>(rgb[0]), static_cast<Real>(rgb[1]), static_cast<Real>(rgb[2])};
}

}  // namespace

HairObject::HairObject(const std::string& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) throw std::runtime_error(file + ": cannot be read");
    const auto size = static_cast<std::size_t>(stream.tellg());
    std::vector<Piece> bytes(size / sizeof(Piece) + 1);
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));

    hairloom::game::Error error;
    require(asset_.open(bytes.data(), size, &error), file, error);
    require(asset_.check(&error), file, error);
    const hl_asset_info info = asset_.describe();
    require(hair_.make(asset_, HL_HAIRS, nullptr, &error), file, error);
    for (std::uint32_t b = 0; b < info.bones; ++b) {
        hl_bone bone;
        require(hl_asset_bone(asset_.get(), b, &bone, &error) == HL_OK, file, error);
        bones_.emplace_back(bone.name, bone.name_bytes);
    }
    matrices_.resize(std::size_t{12} * info.bones);

    follow_ = info.hairs > 0;
    if (follow_) {
        for (std::uint32_t h = 0; h <= info.hairs; ++h) offsets_.push_back(h * info.points_per_hair);
    } else {
        offsets_.resize(info.guides + std::size_t{1});
        require(hl_instance_offsets(hair_.get(), offsets_.data(), offsets_.size(), &error) == HL_OK, file,
                error);
    }
    hairs_ = offsets_.size() - 1;
    makeBuffers();

    setMaterial(MaterialManager::getSingleton().getByName("hair"));
    setLook();
    asset_ = {};  // an instance keeps what it needs, and `bytes` go
    read();
}

void HairObject::setLook() {
    getMaterial()->load();
    Pass& lit = *getMaterial()->getTechnique("lit")->getPass(0);
    const GpuProgramParametersSharedPtr light = lit.getFragmentProgramParameters();
    light->setNamedConstant("rootColour",
                            colourOf(asset_.get(), "material.rootColour", Vector3(0.16f, 0.08f, 0.04f)));
    light->setNamedConstant("tipColour",
                            colourOf(asset_.get(), "material.tipColour", Vector3(0.30f, 0.17f, 0.09f)));
    light->setNamedConstant("variation", static_cast<Real>(asset_.number("material.colourVariation", 0.15)));
    const GpuProgramParametersSharedPtr ribbons = lit.getGeometryProgramParameters();
    // They stand for the hundred thousand hairs of a head.
    ribbons->setNamedConstant("widening", std::min(4.0f, std::sqrt(100000.0f / static_cast<float>(hairs_))));
    ribbons->setNamedConstant("segments", static_cast<int>(vertices_.size() / hairs_) - 1);
}

void HairObject::makeBuffers() {
    auto& buffers = HardwareBufferManager::getSingleton();
    const std::size_t points = offsets_.back();
    vertices_.resize(points);
    vertexData_.vertexCount = points;
    vertexData_.vertexDeclaration->addElement(0, offsetof(Vertex, position), VET_FLOAT3, VES_POSITION);
    vertexData_.vertexDeclaration->addElement(0, offsetof(Vertex, tangent), VET_FLOAT3, VES_NORMAL);
    vertexData_.vertexDeclaration->addElement(0, offsetof(Vertex, radius), VET_FLOAT1,
                                              VES_TEXTURE_COORDINATES);
    vertexData_.vertexBufferBinding->setBinding(
        0, buffers.createVertexBuffer(sizeof(Vertex), points,
                                      HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE));

    // Two points a segment; the geometry program makes ribbons of them.
    std::vector<std::uint32_t> lines;
    lines.reserve(2 * points);
    for (std::size_t h = 0; h < hairs_; ++h) {
        for (std::uint32_t p = offsets_[h]; p + 1 < offsets_[h + 1]; ++p)
            lines.insert(lines.end(), {p, p + 1});
    }
    indexData_.indexCount = lines.size();
    indexData_.indexBuffer = buffers.createIndexBuffer(HardwareIndexBuffer::IT_32BIT, lines.size(),
                                                       HardwareBuffer::HBU_STATIC_WRITE_ONLY);
    indexData_.indexBuffer->writeData(0, lines.size() * sizeof(std::uint32_t), lines.data(), true);

    mRenderOp.vertexData = &vertexData_;
    mRenderOp.indexData = &indexData_;
    mRenderOp.useIndexes = true;
    mRenderOp.operationType = RenderOperation::OT_LINE_LIST;
}

void HairObject::step(const Entity& character, float dt, double time, const Vector3& wind) {
    // Ogre's offset transform takes a vertex from where it was bound to where the bone has it now: a skinning
    // matrix.
    const Affine3& node = character.getParentSceneNode()->_getFullTransform();
    for (std::size_t b = 0; b < bones_.size(); ++b) {
        Affine3 offset;
        character.getSkeleton()->getBone(bones_[b])->_getOffsetTransform(offset);
        const Affine3 skinning = node * offset;
        for (std::size_t k = 0; k < 12; ++k) matrices_[12 * b + k] = skinning[k / 4][k % 4];
    }
    float head[12];
    for (std::size_t k = 0; k < 12; ++k) head[k] = node[k / 4][k % 4];

    hairloom::game::Frame frame(dt);
    frame.time = time;
    frame.head = head;  // for what hangs on no bone
    frame.bones = bones_.empty() ? nullptr : matrices_.data();
    frame.bone_count = bones_.size();
    frame.wind = wind.ptr();
    hairloom::game::Error error;
    if (!hair_.step(frame, &error)) throw std::runtime_error(error.words);
    read();
}

void HairObject::read() {
    const auto out = [&](float* first, std::size_t before) {
        return hl_out{first, vertices_.size() * sizeof(Vertex) - before, sizeof(Vertex)};
    };
    const hl_out positions = out(vertices_[0].position, offsetof(Vertex, position)),
                 tangents = out(vertices_[0].tangent, offsetof(Vertex, tangent)),
                 radii = out(&vertices_[0].radius, offsetof(Vertex, radius));
    hairloom::game::Error error;
    const hl_code code = follow_ ? hl_instance_read_hairs(hair_.get(), positions, tangents, radii, &error)
                                 : hl_instance_read_guides(hair_.get(), positions, tangents, radii, &error);
    if (code != HL_OK) throw std::runtime_error(error.words);
    vertexData_.vertexBufferBinding->getBuffer(0)->writeData(0, vertices_.size() * sizeof(Vertex),
                                                             vertices_.data(), true);
    AxisAlignedBox box;
    for (const Vertex& vertex : vertices_)
        box.merge(Vector3(vertex.position[0], vertex.position[1], vertex.position[2]));
    setBoundingBox(box);
    if (mParentNode) mParentNode->needUpdate();
}

std::vector<Vector3> HairObject::roots() const {
    std::vector<Vector3> roots;
    for (std::size_t h = 0; h < hairs_; ++h) roots.emplace_back(vertices_[offsets_[h]].position);
    return roots;
}

Real HairObject::getSquaredViewDepth(const Camera* camera) const {
    return (mBox.getCenter() - camera->getDerivedPosition()).squaredLength();
}
