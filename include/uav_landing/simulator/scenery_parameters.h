#pragma once

namespace uav_landing {

// The surroundings of the runway, element by element. Each one is a section of its own, and does not exist by
// default. Directions are in the runway frame: x along the landing direction from the threshold, y left. A
// direction of 0 is the landing direction, and 90 is to the left. Later elements lie on top of earlier ones.

/// A patchwork of fields with borders and crop rows (section fields). There is none when its length or width
/// is 0.
struct SimulatedFieldsParameters {
  double x = 0, y = 0, direction_deg = 0;
  double length = 0, width = 0;
  double field_length = 250, field_width = 120;
  double brightness = 105, spread = 35, contrast = 0.1;
  double border_width = 4, border_brightness = 55;
  double row_spacing = 3, row_contrast = 0.15;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, -1e5, 1e5, "m", "middle of the patchwork, along the runway from the threshold");
    v.number("y", y, -1e5, 1e5, "m", "middle of the patchwork, left of the centre line");
    v.number("direction_deg", direction_deg, -180.0, 180.0, "deg",
             "direction of the fields' longer borders, left of the landing direction");
    v.number("length", length, 0.0, 2e4, "m", "of the patchwork along its direction; 0: no fields");
    v.number("width", width, 0.0, 2e4, "m", "of the patchwork across its direction; 0: no fields");
    v.number("field_length", field_length, 10.0, 5000.0, "m", "mean length of a field");
    v.number("field_width", field_width, 10.0, 5000.0, "m", "mean width of a field");
    v.number("brightness", brightness, 0.0, 255.0, "grey levels", "mean of the fields");
    v.number("spread", spread, 0.0, 127.0, "grey levels", "most by which a field differs from the mean");
    v.number("contrast", contrast, 0.0, 1.0, "of brightness", "1 sigma of each scale of the texture");
    v.number("border_width", border_width, 0.0, 50.0, "m", "of the hedge or path between two fields");
    v.number("border_brightness", border_brightness, 0.0, 255.0, "grey levels", "mean of the borders");
    v.number("row_spacing", row_spacing, 0.1, 100.0, "m", "from one crop row to the next");
    v.number("row_contrast", row_contrast, 0.0, 1.0, "of brightness", "largest amplitude of the crop rows");
  }
};

/// Water between two wavy banks (sections river and shore). Its near bank follows a straight line through (x,
/// y), and the water lies to the left of that line. There is none when its width is 0.
struct SimulatedWaterParameters {
  double x = 0, y = 0, direction_deg = 0;
  double width = 0;
  double wave = 20, wave_length = 600;
  double brightness = 60, contrast = 0.04;
  double beach_width = 6, beach_brightness = 150;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, -1e5, 1e5, "m", "a point of the near bank, along the runway from the threshold");
    v.number("y", y, -1e5, 1e5, "m", "the same point, left of the centre line");
    v.number("direction_deg", direction_deg, -180.0, 180.0, "deg",
             "direction of the bank, left of the landing direction; the water lies to its left");
    v.number("width", width, 0.0, 1e5, "m", "from bank to bank; 0: no water");
    v.number("wave", wave, 0.0, 1000.0, "m", "by which the banks swing to each side of a straight line");
    v.number("wave_length", wave_length, 10.0, 1e5, "m", "from one swing to the next");
    v.number("brightness", brightness, 0.0, 255.0, "grey levels", "mean of the water");
    v.number("contrast", contrast, 0.0, 1.0, "of brightness", "1 sigma of each scale of its texture");
    v.number("beach_width", beach_width, 0.0, 200.0, "m", "of the sand along each bank");
    v.number("beach_brightness", beach_brightness, 0.0, 255.0, "grey levels", "mean of the sand");
  }
};

/// A grid of streets with plots between them, most with a house (section town). There is none when its length
/// or width is 0.
struct SimulatedTownParameters {
  double x = 0, y = 0, direction_deg = 0;
  double length = 0, width = 0;
  double block_length = 120, block_width = 44, street_width = 9;
  double plot = 22, built = 0.85;
  double street_brightness = 60;
  double roof_brightness = 120, roof_spread = 70;
  double garden_brightness = 100, contrast = 0.12;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, -1e5, 1e5, "m", "middle of the town, along the runway from the threshold");
    v.number("y", y, -1e5, 1e5, "m", "middle of the town, left of the centre line");
    v.number("direction_deg", direction_deg, -180.0, 180.0, "deg",
             "direction of the longer streets, left of the landing direction");
    v.number("length", length, 0.0, 5000.0, "m", "of the town along its direction; 0: no town");
    v.number("width", width, 0.0, 5000.0, "m", "of the town across its direction; 0: no town");
    v.number("block_length", block_length, 20.0, 1000.0, "m", "between two streets, along the direction");
    v.number("block_width", block_width, 20.0, 1000.0, "m", "between two streets, across the direction");
    v.number("street_width", street_width, 0.5, 100.0, "m", "of each street");
    v.number("plot", plot, 10.0, 200.0, "m", "side of the plot on which a house stands, about");
    v.number("built", built, 0.0, 1.0, "", "share of the plots with a house");
    v.number("street_brightness", street_brightness, 0.0, 255.0, "grey levels", "mean of the streets");
    v.number("roof_brightness", roof_brightness, 0.0, 255.0, "grey levels", "mean of the roofs");
    v.number("roof_spread", roof_spread, 0.0, 127.0, "grey levels",
             "most by which a roof differs from the mean");
    v.number("garden_brightness", garden_brightness, 0.0, 255.0, "grey levels", "mean of the gardens");
    v.number("contrast", contrast, 0.0, 1.0, "of brightness", "1 sigma of each scale of the texture");
  }
};

/// Mown grass around the runway, over fields, water and town (section grass_strip). There is none when its
/// side is 0.
struct SimulatedGrassStripParameters {
  double side = 0, end = 60;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("side", side, 0.0, 1000.0, "m", "from the runway's edge outwards; 0: no strip");
    v.number("end", end, 0.0, 1000.0, "m", "beyond each end of the runway's surface");
  }
};

/// A straight paved strip with lines (sections road and taxiway). There is none when its length or width is
/// 0.
struct SimulatedStripParameters {
  double x = 0, y = 0, direction_deg = 0;
  double length = 0, width = 0;
  double brightness = 80, contrast = 0.08;
  double edge_line_width = 0;
  double centre_line_width = 0, centre_dash_length = 6, centre_gap_length = 6;
  double line_brightness = 180;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, -1e5, 1e5, "m", "middle of the strip, along the runway from the threshold");
    v.number("y", y, -1e5, 1e5, "m", "middle of the strip, left of the centre line");
    v.number("direction_deg", direction_deg, -180.0, 180.0, "deg", "left of the landing direction");
    v.number("length", length, 0.0, 1e5, "m", "of the strip; 0: none");
    v.number("width", width, 0.0, 1000.0, "m", "of the strip; 0: none");
    v.number("brightness", brightness, 0.0, 255.0, "grey levels", "mean of its surface");
    v.number("contrast", contrast, 0.0, 1.0, "of brightness", "1 sigma of each scale of its texture");
    v.number("edge_line_width", edge_line_width, 0.0, 10.0, "m", "of the line along each side; 0: none");
    v.number("centre_line_width", centre_line_width, 0.0, 10.0, "m", "of the centre line; 0: none");
    v.number("centre_dash_length", centre_dash_length, 0.001, 1000.0, "m", "of one dash");
    v.number("centre_gap_length", centre_gap_length, 0.0, 1000.0, "m", "between two dashes; 0: a solid line");
    v.number("line_brightness", line_brightness, 0.0, 255.0, "grey levels", "mean of its lines");
  }
};

/// A second runway with the surface and markings of the first one, below it (section crossing_runway). There
/// is none when its length or width is 0.
struct SimulatedCrossingParameters {
  double x = 500, y = 0, direction_deg = 60;
  double length = 0, width = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, -1e5, 1e5, "m", "middle of the runway, along the other one from the threshold");
    v.number("y", y, -1e5, 1e5, "m", "middle of the runway, left of the other one's centre line");
    v.number("direction_deg", direction_deg, -180.0, 180.0, "deg", "left of the landing direction");
    v.number("length", length, 0.0, 1e5, "m", "of the runway; 0: none");
    v.number("width", width, 0.0, 1000.0, "m", "of the runway; 0: none");
  }
};

/// The aircraft's own nose and a post of its window (section own_frame). They are always at the same place of
/// each camera's raw image.
struct SimulatedOwnFrameParameters {
  double nose_height = 0, nose_width = 0.5;
  double nose_left = 0.6, nose_right = 0.4;
  double nose_brightness = 45;
  double post_width = 0;
  double post_left = 0.15, post_right = 0.85;
  double post_tilt_deg = 15;
  double post_brightness = 25;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("nose_height", nose_height, 0.0, 1.0, "of the image's height",
             "the nose covers the image up to this; 0: no nose");
    v.number("nose_width", nose_width, 0.01, 3.0, "of the image's width", "of the nose at the bottom");
    v.number("nose_left", nose_left, -1.0, 2.0, "of the image's width",
             "middle of the nose in the left camera's image");
    v.number("nose_right", nose_right, -1.0, 2.0, "of the image's width", "and in the right camera's");
    v.number("nose_brightness", nose_brightness, 0.0, 255.0, "grey levels",
             "of the nose; it is brighter along its middle");
    v.number("post_width", post_width, 0.0, 1.0, "of the image's width",
             "thickness of the window post; 0: none");
    v.number("post_left", post_left, -1.0, 2.0, "of the image's width",
             "middle of the post in the middle row of the left camera's image");
    v.number("post_right", post_right, -1.0, 2.0, "of the image's width", "and of the right camera's");
    v.number("post_tilt_deg", post_tilt_deg, -60.0, 60.0, "deg",
             "of the post's upper end to the right, in the right camera's image to the left");
    v.number("post_brightness", post_brightness, 0.0, 255.0, "grey levels", "of the post");
  }
};

/// All elements of the scenery.
struct SimulatedSceneryParameters {
  SimulatedFieldsParameters fields;
  SimulatedWaterParameters river, shore;
  SimulatedTownParameters town;
  SimulatedGrassStripParameters grass_strip;
  SimulatedStripParameters road, taxiway;
  SimulatedCrossingParameters crossing_runway;
  SimulatedOwnFrameParameters own_frame;

  /// Calls v(section name, parameter struct) for every section.
  template <class Visitor>
  void visitSections(Visitor&& v) {
    v("fields", fields);
    v("river", river);
    v("shore", shore);
    v("town", town);
    v("grass_strip", grass_strip);
    v("road", road);
    v("taxiway", taxiway);
    v("crossing_runway", crossing_runway);
    v("own_frame", own_frame);
  }
};

}  // namespace uav_landing
