#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "stereo/photometric/band_sums.h"
#include "stereo/photometric/texture_bands.h"

namespace uav_landing {

/// What blocks say of the shift between the left image and the aligned right one: sums over blocks and bands.
struct BandEvidence {
  double information = 0;           ///< of the shift, 1/pixels^2 of the whole images
  double shift_by_information = 0;  ///< left pixels by which the left image is to be moved, times that
  double lean_by_information = 0;   ///< by how much the shift grows where the right image lies a pixel higher
  double alike = 0, other = 0;      ///< of what the right image has there, over the noise: the like, the rest

  void add(const BandEvidence& more);
  double shift() const { return shift_by_information / information; }
  double lean() const { return lean_by_information / information; }
  /// 1 sigma of the shift; infinite where nothing tells it.
  double stddev() const { return 1 / std::sqrt(information); }
  bool looksAlike() const;
};

/// Gain of the right image over the left one by a band of them, both with the same noise (total least
/// squares); none where they have nothing in common.
std::optional<double> gainOf(const std::vector<BandSums>& sums);

/// What is alike in all blocks of a band.
struct BandNoise {
  /// Variance of the right image's pixels beside the left one's, where they fit: in three quarters of the
  /// blocks it is larger.
  double residual = 0;
  /// A score's variance over what it were if pixels were independent. Of blocks with their neighbours, as the
  /// filters make their errors alike.
  double colour = 0;
};
/// around: as by addNeighbours().
BandNoise noiseOf(const BlockGrid& grid, const std::vector<BandSums>& around, double gain);

/// What a block has said in a band.
struct BandScore {
  double score = 0;
  double response = 0, lean = 0;  ///< to a shift by a pixel, and by a row
  double stddev = 0;              ///< of the score; 0: it said nothing
};

/// Adds what the blocks of one band say. Each counts by its signal over its noise (Knapp, Carter 1976: the
/// weights of the best delay between two receivers of a faint signal), where the signal is what the slopes of
/// both images have in common. That of a faint block is mostly chance, but much like those of its neighbours,
/// so it is drawn towards their mean unless it differs by more than chance (James, Stein 1961). What all of
/// them owe to chance in spite of that is known on average, and taken out. white: of
/// the band. scores: of the next coarser band, whose share in this one's is taken out; then of this one.
void addEvidence(const BlockGrid& grid, const std::vector<BandSums>& sums,
                 const std::vector<BandSums>& around, double gain, const BandNoise& noise,
                 const TextureBands::Noise& white, std::vector<BandScore>& scores,
                 std::vector<BandEvidence>& evidence);

}  // namespace uav_landing
