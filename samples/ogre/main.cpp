// SPDX-License-Identifier: GPL-3.0-or-later
// Hair in Ogre: a skinned head plays its clip in wind, its hair follows.
//   ogre_hair HAIR.hairrt CHARACTER.glb [--frames N] [--wind METRES_PER_SECOND] [--size PIXELS] [--picture
//   F.png]

#include <OgreAnimationState.h>
#include <OgreCamera.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreLogManager.h>
#include <OgreMaterialManager.h>
#include <OgreRenderTexture.h>
#include <OgreRenderWindow.h>
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <OgreSkeletonInstance.h>
#include <OgreSubEntity.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <OgreViewport.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "character.h"
#include "hair_object.h"

using namespace Ogre;

namespace {

struct Options {
    std::string hair, character, picture;
    int frames = 240;
    float wind = 2;
    unsigned size = 720;
};

bool parse(int count, char** words, Options& options) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word.rfind("--", 0) != 0) {
            (options.hair.empty() ? options.hair : options.character) = word;
            continue;
        }
        if (i + 1 == count) return false;
        const char* const value = words[++i];
        if (word == "--frames")
            options.frames = std::atoi(value);
        else if (word == "--wind")
            options.wind = static_cast<float>(std::atof(value));
        else if (word == "--size")
            options.size = static_cast<unsigned>(std::atoi(value));
        else if (word == "--picture")
            options.picture = value;
        else
            return false;
    }
    return !options.character.empty() && options.frames > 0 && options.size >= 16 && options.size <= 4096;
}

/// What the sun sees: metres along its light, by which hair shades hair and skin.
void addSun(SceneManager& scene, const Vector3& middle) {
    constexpr Real kHalf = 0.35f, kAway = 1.5f;
    const Vector3 sun = Vector3(0.75f, 0.9f, 0.65f).normalisedCopy();
    Camera* const camera = scene.createCamera("sun");
    camera->setProjectionType(PT_ORTHOGRAPHIC);
    camera->setOrthoWindow(2 * kHalf, 2 * kHalf);
    camera->setNearClipDistance(0.1f);
    camera->setFarClipDistance(3);
    SceneNode* const node = scene.getRootSceneNode()->createChildSceneNode(middle + sun * kAway);
    node->attachObject(camera);
    node->lookAt(middle, Node::TS_WORLD);
    node->_update(true, true);

    const TexturePtr depths = TextureManager::getSingleton().getByName("sun_depths");
    Viewport* const view = depths->getBuffer()->getRenderTarget()->addViewport(camera);
    view->setMaterialScheme("depth");
    view->setBackgroundColour(ColourValue(100, 100, 100));
    view->setOverlaysEnabled(false);

    // Ogre draws textures so that their first row is the upper one.
    const Matrix4 toTexture(0.5f, 0, 0, 0.5f, 0, -0.5f, 0, 0.5f, 0, 0, 1, 0, 0, 0, 0, 1);
    const Matrix4 toLight = toTexture * camera->getProjectionMatrix() * Matrix4(camera->getViewMatrix());
    for (const char* const name : {"hair", "skin"}) {
        const MaterialPtr material = MaterialManager::getSingleton().getByName(name);
        material->load();
        const auto set = [&](const char* technique, bool isLit) {
            const auto parameters =
                material->getTechnique(technique)->getPass(0)->getFragmentProgramParameters();
            parameters->setNamedConstant("sun", sun);
            parameters->setNamedConstant("sunPosition", middle + sun * kAway);
            if (!isLit) return;
            parameters->setNamedConstant("toLight", toLight);
            parameters->setNamedConstant("middle", middle);
        };
        set("lit", true);
        set("depth", false);
    }
}

/// Vertices where Ogre has skinned them.
std::vector<Vector3> skinnedVertices(Entity& entity) {
    entity._updateAnimation();
    const Affine3& node = entity.getParentSceneNode()->_getFullTransform();
    std::vector<Vector3> vertices;
    for (std::size_t part = 0; part < entity.getNumSubEntities(); ++part) {
        const VertexData& data = *entity.getSubEntity(part)->_getSkelAnimVertexData();
        const VertexElement& element = *data.vertexDeclaration->findElementBySemantic(VES_POSITION);
        const auto buffer = data.vertexBufferBinding->getBuffer(element.getSource());
        auto* const bytes = static_cast<unsigned char*>(buffer->lock(HardwareBuffer::HBL_READ_ONLY));
        for (std::size_t v = 0; v < data.vertexCount; ++v) {
            float* position;
            element.baseVertexPointerToElement(bytes + v * buffer->getVertexSize(), &position);
            vertices.push_back(node * Vector3(position));
        }
        buffer->unlock();
    }
    return vertices;
}

/// How far a root is from the vertex that is nearest to it at rest; what moves with the skin keeps it.
class Hold {
  public:
    Hold(const std::vector<Vector3>& roots, const std::vector<Vector3>& vertices) {
        for (const Vector3& root : roots) {
            const auto nearest =
                std::min_element(vertices.begin(), vertices.end(), [&](const Vector3& a, const Vector3& b) {
                    return a.squaredDistance(root) < b.squaredDistance(root);
                });
            held_.push_back({static_cast<std::size_t>(nearest - vertices.begin()), nearest->distance(root)});
        }
    }
    /// Metres.
    Real greatestSlip(const std::vector<Vector3>& roots, const std::vector<Vector3>& vertices) const {
        Real slip = 0;
        for (std::size_t r = 0; r < roots.size(); ++r)
            slip = std::max(slip, std::abs(vertices[held_[r].vertex].distance(roots[r]) - held_[r].distance));
        return slip;
    }

  private:
    struct Held {
        std::size_t vertex;
        Real distance;
    };
    std::vector<Held> held_;
};

RenderWindow* openWindow(Root& root, unsigned size) {
    root.loadPlugin(OGRE_PLUGINS "/RenderSystem_GL3Plus");
    root.loadPlugin(OGRE_PLUGINS "/Codec_STBI");
    root.setRenderSystem(root.getAvailableRenderers().front());
    root.initialise(false);
    NameValuePairList more;
    more["FSAA"] = "4";
    RenderWindow* const window = root.createRenderWindow("Hair in Ogre", size, size, false, &more);
    // What materials name has to be there before they are read.
    TextureManager::getSingleton().createManual("sun_depths",
                                                ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME,
                                                TEX_TYPE_2D, 1024, 1024, 0, PF_FLOAT32_R, TU_RENDERTARGET);
    auto& resources = ResourceGroupManager::getSingleton();
    resources.addResourceLocation(MEDIA, "FileSystem");
    resources.initialiseAllResourceGroups();
    return window;
}

void play(const Options& options) {
    LogManager log;
    log.createLog("ogre_hair", true, false, true);
    Root root("", "", "");
    RenderWindow* const window = openWindow(root, options.size);
    SceneManager& scene = *root.createSceneManager();

    Entity& character = *scene.createEntity(loadCharacter(options.character, "character"));
    scene.getRootSceneNode()->createChildSceneNode()->attachObject(&character);
    character.addSoftwareAnimationRequest(false);
    AnimationState& clip = *character.getAllAnimationStates()->getAnimationStates().begin()->second;
    clip.setEnabled(true);
    clip.setLoop(true);

    const AxisAlignedBox box = character.getMesh()->getBounds();
    const Vector3 middle(0, box.getMaximum().y - 0.16f, 0);
    addSun(scene, middle);
    HairObject hair(options.hair);
    scene.getRootSceneNode()->attachObject(&hair);

    Camera& camera = *scene.createCamera("eye");
    camera.setNearClipDistance(0.05f);
    camera.setFarClipDistance(20);
    camera.setFOVy(Degree(28));
    camera.setAspectRatio(1);
    SceneNode& eye = *scene.getRootSceneNode()->createChildSceneNode(
        middle + Vector3(0.55f, 0.18f, 0.85f).normalisedCopy() * 1.05f);
    eye.attachObject(&camera);
    eye.lookAt(middle, Node::TS_WORLD);
    window->addViewport(&camera)->setBackgroundColour(ColourValue(0.165f, 0.172f, 0.192f));

    const Hold hold(hair.roots(), skinnedVertices(character));
    Real slip = 0;
    double stepped = 0;
    for (int f = 1; f <= options.frames && !window->isClosed(); ++f) {
        clip.addTime(1.0f / 60);
        const std::vector<Vector3> vertices = skinnedVertices(character);
        const auto begin = std::chrono::steady_clock::now();
        hair.step(character, 1.0f / 60, f / 60.0, Vector3(options.wind, 0, 0));
        stepped +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        slip = std::max(slip, hold.greatestSlip(hair.roots(), vertices));
        // A picture wants its last frame alone; processors that draw take long.
        if (options.picture.empty() || f == options.frames) root.renderOneFrame();
    }
    if (!options.picture.empty()) window->writeContentsToFile(options.picture);
    std::printf("%zu hairs, %.2f ms per frame, roots within %.4f mm of the skin, state %016llx\n",
                hair.hairs(), stepped / options.frames, static_cast<double>(1e3f * slip),
                static_cast<unsigned long long>(hair.instance().hash()));
    hair.detachFromParent();
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!parse(count, words, options)) {
        std::fprintf(stderr,
                     "ogre_hair HAIR.hairrt CHARACTER.glb [--frames N] [--wind METRES_PER_SECOND] "
                     "[--size PIXELS] [--picture F.png]\n");
        return 2;
    }
    try {
        play(options);
        return 0;
    } catch (const std::exception& thrown) {
        std::fprintf(stderr, "error: %s\n", thrown.what());
        return 1;
    }
}
