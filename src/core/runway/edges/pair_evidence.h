#pragma once

#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/edges/symmetry_search.h"

namespace uav_landing {

/// The view beside the runway. With it, a missing edge is evidence, too.
struct Outlook {
  const StereoRig& rig;
  const std::vector<GroundEdge>& edges;  ///< edges seen by at least one view
};

/// Evidence for and against pairs of edges as those of the runway. The edges of a pair are among `edges`.
/// Those given to a function are all that may speak against the pair.
class PairEvidence {
 public:
  PairEvidence(const GroundAxes& axes, const std::vector<GroundEdge>& edges) : axes_(axes), edges_(edges) {}

  /// Whether the pair is a dark strip that begins within the image, as it does at a threshold.
  bool isStrip(const MirroredPair& pair) const;
  /// Whether one edge of the pair seems to be the centre line of a wider runway. It would lie halfway between
  /// the other edge and a long edge beyond it. With such edges beyond both sides, the pair is the middle of a
  /// symmetric whole.
  bool isHalf(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const;
  /// Whether much longer edges lie beyond the pair. The runway's own are the longest but for a river or a
  /// road, and those are not that much longer. So the pair is of marks.
  bool isDwarfed(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const;
  /// Whether all pairs are short, and end where a longer line goes on, as bars of a threshold do.
  bool areMarks(const Symmetry& symmetry, const std::vector<GroundEdge>& edges) const;
  /// Whether the pair is two painted lines with nothing at the same distance beyond either of them. If one
  /// line were the centre line of a wider runway, its other edge line would be seen there.
  bool areOutermost(const Symmetry& symmetry, const MirroredPair& outermost, const Outlook& outlook) const;
  /// Whether the pairs are two unbroken lines that look alike, each with both of its sides. A single dash is
  /// no counterpart of a continuous line.
  bool areTwoLines(const Symmetry& symmetry) const;
  /// Whether more than two lines share the symmetry.
  ///
  /// Any two lines are symmetric about their middle with both of their sides. A piece of texture may be as
  /// well, and so may the sides of one mark. These are more than that:
  /// - A narrow bright stripe lies in the middle: the centre line.
  /// - There are two marks or more, such as bars of a threshold.
  /// - There are more than two long pairs, such as edge lines with the edges of the pavement beyond.
  /// - Long pairs have very different widths, so they cannot be the sides of two lines.
  bool hasMoreThanTwoLines(const Symmetry& symmetry, const MirroredPair& outermost) const;

 private:
  /// Whether both edges of the pair are equally long. A runway's edges are; its centre line is shorter than
  /// they.
  bool isEven(const MirroredPair& pair) const;
  /// Whether most of the edge is seen. A centre line is dashed and fails this.
  static bool isUnbroken(const GroundEdge& edge);
  /// Whether both edges begin at the same distance, or neither begins within the image.
  bool beginAlike(const MirroredPair& pair) const;
  /// Whether a line like those of the pair would be seen at this place, but none is.
  bool isBare(double lateral, const MirroredPair& pair, const Outlook& outlook) const;
  /// log(far / near) of the part that the left camera sees of a line along the runway between these
  /// distances.
  double seenExtent(double lateral, double near, double far, const StereoRig& rig) const;

  const GroundAxes& axes_;
  const std::vector<GroundEdge>& edges_;
};

}  // namespace uav_landing
