// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One character's hair as Ogre knows things: attached to a scene node, it is seen, culled and drawn with all
// else.

#include <OgreEntity.h>
#include <OgreSimpleRenderable.h>

#include <hairloom/hairloom.hpp>
#include <string>
#include <vector>

/// Points lie in the world: attach it to a node that does not move, the root of the scene, say.
class HairObject : public Ogre::SimpleRenderable {
  public:
    /// Of the asset's follow hairs, or its guides where it has none, drawn by the material "hair". Throws
    /// std::runtime_error with the words of the library where the asset is refused.
    explicit HairObject(const std::string& file);

    /// One frame: roots and spheres go where `character`, whose skeleton the asset was made for, has its
    /// bones now; then all hairs are read into the vertex buffer. `wind` in m/s.
    void step(const Ogre::Entity& character, float dt, double time, const Ogre::Vector3& wind);

    /// Where guides begin.
    std::vector<Ogre::Vector3> roots() const;
    const hairloom::game::Instance& instance() const { return hair_; }
    std::size_t hairs() const { return hairs_; }

    Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;
    Ogre::Real getBoundingRadius() const override { return mBox.getHalfSize().length(); }

  private:
    /// As the vertex declaration has it, and as the library writes it.
    struct Vertex {
        float position[3], tangent[3], radius;
    };
    void makeBuffers();
    void setLook();
    void read();

    hairloom::game::Asset asset_;
    hairloom::game::Instance hair_;
    std::vector<std::string> bones_;  ///< names, in the asset's order
    std::vector<float> matrices_;
    std::vector<std::uint32_t> offsets_;  ///< first point of each line that is drawn, and their number
    std::vector<Vertex> vertices_;
    std::size_t hairs_ = 0;
    bool follow_ = false;  ///< whether follow hairs are drawn
    Ogre::VertexData vertexData_;
    Ogre::IndexData indexData_;
};
