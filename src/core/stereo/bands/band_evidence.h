#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "stereo/bands/band_sums.h"
#include "stereo/bands/texture_bands.h"

namespace uav_landing {

/// Evidence of blocks about the shift between the left image and the aligned right one, summed over blocks
/// and bands.
struct BandEvidence {
  double information = 0;           ///< of the shift, 1/pixels^2 of the whole images
  double shift_by_information = 0;  ///< shift of the left image in left pixels, times information
  double lean_by_information = 0;   ///< growth of the shift when the right image lies a pixel higher, times
                                    ///< information
  double alike = 0, other = 0;      ///< content of the right image over the noise: the like part, and the
                                    ///< rest

  void add(const BandEvidence& more);
  double shift() const { return shift_by_information / information; }
  double lean() const { return lean_by_information / information; }
  /// 1 sigma of the shift, pixels; infinite when nothing tells it.
  double stddev() const { return 1 / std::sqrt(information); }
  bool looksAlike() const;
};

/// Gain of the right image over the left one in a band. Both have the same noise (total least squares). None
/// when they have nothing in common.
std::optional<double> gainOf(const std::vector<BandSums>& sums);

/// Noise that all blocks of a band have alike.
struct BandNoise {
  /// Variance of the difference between right and left pixels where the images fit. Three quarters of the
  /// blocks have a larger one.
  double residual = 0;
  /// Factor on a score's variance over that of independent pixels, because the filters make errors of
  /// neighbours alike. It is measured on blocks with their neighbours.
  double colour = 0;
};
/// around: as by addNeighbours().
BandNoise noiseOf(const BlockGrid& grid, const std::vector<BandSums>& around, double gain);

/// The blocks of one band, as they were compared.
struct ComparedBand {
  const std::vector<BandSums>& sums;    ///< of each block
  const std::vector<BandSums>& around;  ///< of each block with its neighbours (addNeighbours())
  double gain;                          ///< of the right image over the left one
  BandNoise noise;
  TextureBands::Noise white;  ///< effect of white noise in this band
};

/// What a block tells in a band.
struct BandScore {
  double score = 0;
  double response = 0, lean = 0;  ///< to a shift by a pixel, and by a row
  double stddev = 0;              ///< of the score; 0: it tells nothing
};

/// Adds the evidence of the blocks of one band. Each counts by its signal over its noise: the weights of the
/// best delay between two receivers of a faint signal (Knapp, Carter 1976). The signal is the common part of
/// both images' slopes.
/// The signal of a faint block is mostly chance, but much like that of its neighbours. So it is drawn towards
/// their mean, unless it differs by more than chance (James, Stein 1961). The remaining effect of chance is
/// known on average and taken out. scores: of the next coarser band on entry, whose share
/// in this band is taken out; of this band on return.
void addEvidence(const BlockGrid& grid, const ComparedBand& band, std::vector<BandScore>& scores,
                 std::vector<BandEvidence>& evidence);

}  // namespace uav_landing
