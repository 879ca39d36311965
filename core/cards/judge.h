// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Draws strands, cards and shells by one rule, without perspective, and says how far apart they look. Simple
// and slow: what it draws is to be compared, and shown beside the strands.

#include "core/cards/cards.h"
#include "core/cards/shell.h"
#include "core/render/image.h"

namespace hairloom::cards {

/// The head that all sizes are told by: a head of 0.25 m.
constexpr float kHeadHeight = 0.25f;
/// Samples along the height of a head in pictures of strands: 0.16 mm apart.
constexpr std::uint32_t kSamplesPerHead = 1536;

/// A direction that hair is looked at from, and how much of the plane across it a picture shows.
struct View {
    Vec3f toEye_ws, right_ws, up_ws;  ///< unit, perpendicular
    Vec3f corner_ws;                  ///< upper left
    std::uint32_t columns = 0,
                  rows = 0;  ///< of squares of a 32nd of a head: pictures of all sizes divide them
};
/// `count` ≥ 1 around the head, at three heights, each with a margin around all hair; or as many that lie
/// half-way between those, each at another height than that before it.
enum class Around { own, between };
std::vector<View> viewsAround(const Hair& hair, std::uint32_t count, Around around = Around::own);

/// What a pixel shows, linear light.
struct Shot {
    std::uint32_t width = 0, height = 0;
    std::vector<float> coverage;  ///< by hair, 0 … 1
    std::vector<float> skin;      ///< share that shows the head, 0 … 1
    std::vector<Vec3f> hair;      ///< light of hair, times its coverage
    std::vector<Vec3f> all;       ///< of hair, head and background
};

/// Of linear light, by Rec. 709.
inline float luminance(const Vec3f& rgb) {
    return 0.2126f * rgb.x() + 0.7152f * rgb.y() + 0.0722f * rgb.z();
}

/// Light that reaches the points of strands; the part that no direction changes.
struct StrandLight {
    std::vector<float> open, lit;
};
StrandLight strandLight(const Hair& hair, const HairLight& light);

/// A picture of samples, before it is one of pixels.
class Plate {
  public:
    Plate() = default;
    Plate(const View& view, std::uint32_t samplesPerHead) { start(view, samplesPerHead); }
    /// Anew, in the memory that it has. `samplesPerHead` along the height of a head, a multiple of 32.
    void start(const View& view, std::uint32_t samplesPerHead);
    void drawHead(const Hair& hair);
    void drawStrands(const Hair& hair, const StrandLight& light);
    /// What strands cover as drawStrands() has it, before what is drawn by now. Their light is not known, and
    /// nothing can be drawn before them.
    void coverByStrands(const Hair& hair);
    /// Alpha is dithered, each sample by itself, and mip maps are those of pixels of that many a head.
    void drawCards(const Hair& hair, const HairLight& light, const Cards& cards, std::uint32_t headPx);
    void drawShell(const Hair& hair, const HairLight& light, const Shell& shell);
    /// `headPx` divides the samples a head.
    Shot developed(std::uint32_t headPx) const;

  private:
    /// What of a card a sample shows.
    struct Seen {
        std::uint32_t triangle = UINT32_MAX;
        float b0 = 0, b1 = 0;
    };
    /// Strands on the plate, as many as are drawn at once.
    struct Projected {
        std::vector<float> xs, ys, radii, depths;
        std::vector<Vec3f> colours;
        std::vector<std::vector<std::uint32_t>> bands;  ///< by rows, the first points of segments
    };
    Vec3f onPlate(const Vec3f& point_ws) const;  ///< samples, and metres towards the eye
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    template <class Draw>
    void forStrandSamples(const Hair& hair, const StrandLight* light, const Draw& draw);
    void project(const Hair& hair, const StrandLight* light, std::size_t strand);
    View view_;
    std::uint32_t samplesPerHead_ = 0;
    float perMetre_ = 0;
    int width_ = 0, height_ = 0;
    std::vector<float> depth_;
    std::vector<Vec3f> colour_;
    std::vector<std::uint8_t> isHair_;
    // Kept for their memory.
    std::vector<Seen> seen_;
    Projected projected_;
};

/// Luminance of hair, summed up over the pixels of pictures.
double hairLuminance(std::span<const Shot> shots);

/// As people see it.
render::Image shownAs(const Shot& shot);

/// What a level has of what the strands have, over all directions.
struct Shares {
    double coverage = 1;  ///< by its hair
    double light = 1;     ///< of its hair, summed up
};
Shares sharesOf(std::span<const Shot> strands, std::span<const Shot> level);

/// How a level differs from the strands, over all directions.
struct Difference {
    double coverage = 1;      ///< by its hair, times that of the strands
    double light = 1;         ///< of its hair, summed up, times that of the strands
    double flip = 0;          ///< mean over pictures and pixels
    double worstFlip = 0;     ///< of one picture
    double silhouettePx = 0;  ///< mean distance between outlines: area between them by their length
};
Result<Difference> difference(std::span<const Shot> strands, std::span<const Shot> level);

}  // namespace hairloom::cards
