#pragma once
// What each value of a document consists of, in files: once for writing and for reading (field_json.h). Part of this
// room.

#include "app/document/field_json.h"

namespace dubsar {
void fields(auto& f, WedgeBefore& v) {
  f("order", v.order);
  f("clear", v.clear);
}
}  // namespace dubsar

namespace dubsar::app {

/// Of what is written; one more with each field that comes or goes. What older files lack is as in a new document.
inline constexpr int kDocumentVersion = 7;

void fields(auto& f, SourceFile& v) {
  f("path", v.path);
  f("bytes", v.bytes);
  f("content", v.content);
  f("scan", v.scan);
}
void fields(auto& f, Part& v) {
  f("name", v.name);
  f("partitions", v.partitions);
  f("visible", v.visible);
  f("colour", v.colour);
  f("opacity", v.opacity);
  f("offset_mm", v.offset_mm);
}
void fields(auto& f, CameraPose& v) {
  f("rotation_wxyz", v.rotation);
  f("zoom", v.zoom);
  f("pan", v.pan);
}
void fields(auto& f, LightPlace& v) {
  f("azimuth_deg", v.azimuth_deg);
  f("elevation_deg", v.elevation_deg);
}
void fields(auto& f, StyleChoice& v) {
  f("name", v.name);
  f("strength", v.strength);
  f("occlusion", v.occlusion);
  f("evidence", v.evidence);
  f("hatch", v.hatch);
  f("other", v.other);
  f("share", v.share);
  f("radiance", v.radiance);
  f("colours", v.colours);
  f("back_faces", v.back_faces);
  f("section", v.section);
}
void fields(auto& f, Companion& v) {
  f("path", v.path);
  f("content", v.content);
  f("difference_mm", v.difference_mm);
}
void fields(auto& f, Cut& v) {
  f("normal", v.normal);
  f("distance_mm", v.distance_mm);
  f("on", v.on);
}
void fields(auto& f, MeasureFigures& v) {
  f("straight_mm", v.straight_mm);
  f("surface_mm", v.surface_mm);
  f("angle_deg", v.angle_deg);
  f("depth_mm", v.depth_mm);
  f("uncertainty_mm", v.uncertainty_mm);
  f("path_mm", v.path_mm);
}
void fields(auto& f, Measure& v) {
  f("kind", v.kind);
  f("name", v.name);
  f("part", v.part);
  f("points_mm", v.points_mm);
  f("figures", v.figures);
  f("id", v.id);
}
void fields(auto& f, Note& v) {
  f("part", v.part);
  f("label", v.label);
  f("text", v.text);
  f("at_mm", v.at_mm);
  f("normal", v.normal);
  f("line_mm", v.line_mm);
  f("camera", v.camera);
  f("translation", v.translation);
  f("created", v.created);
  f("id", v.id);
}
void fields(auto& f, TabletEdition& v) {
  f("museum_number", v.record.museum_number);
  f("p_number", v.record.p_number);
  f("title", v.record.title);
  f("institution", v.record.institution);
  f("rights", v.record.rights);
  f("creator", v.record.creator);
  f("language", v.record.language);
  f("translated", v.record.translated);
  f("atf", v.atf);
}
void fields(auto& f, MarkedWedge& v) {
  f("by", v.wedge.by);
  f("deleted", v.deleted);
  f("kind", v.wedge.kind);
  f("side", v.wedge.side);
  f("column", v.wedge.column);
  f("line", v.wedge.line);
  f("order", v.wedge.order);
  f("head_mm", v.wedge.head_mm);
  f("left_mm", v.wedge.corner_mm[0]);
  f("right_mm", v.wedge.corner_mm[1]);
  f("tip_mm", v.wedge.tip_mm);
  f("tail_mm", v.wedge.tail_mm);
  f("normal", v.wedge.normal);
  f("direction", v.wedge.direction);
  f("depth_mm", v.wedge.depth_mm);
  f("length_mm", v.wedge.length_mm);
  f("width_mm", v.wedge.width_mm);
  f("opening_deg", v.wedge.opening_deg);
  f("confidence", v.wedge.confidence);
  f("pressed_after", v.wedge.pressed_after);
  f("part", v.part);
  f("id", v.id);
}
void fields(auto& f, ScanView& v) {
  f("cursor_mm", v.cursor_mm);
  f("centre_mm", v.centre_mm);
  f("free_right", v.free_right);
  f("free_up", v.free_up);
  f("zoom", v.zoom);
  f("black", v.black);
  f("white", v.white);
  f("large", v.large);
}
void fields(auto& f, KeyedPart& v) {
  f("name", v.name);
  f("opacity", v.opacity);
  f("offset_mm", v.offset_mm);
}
void fields(auto& f, KeyedShade& v) {
  f("other", v.other);
  f("share", v.share);
  f("radiance", v.radiance);
  f("strength", v.strength);
}
void fields(auto& f, Keyframe& v) {
  f("time_s", v.time_s);
  f("camera", v.camera);
  f("light", v.light);
  f("unpack", v.unpack);
  f("style", v.style);
  f("parts", v.parts);
  f("shade", v.shade);
}
void fields(auto& f, Document& v) {
  f("source", v.source);
  f("parts", v.parts);
  f("unpack", v.unpack);
  f("home", v.home);
  f("now", v.now);
  f("home_light", v.home_light);
  f("light", v.light);
  f("style", v.style);
  f("companion", v.companion);
  f("clips", v.clips);
  f("fog", v.fog);
  f("measures", v.measures);
  f("notes", v.notes);
  f("edition", v.edition);
  f("wedges", v.edition.wedges);
  f("scan", v.scan);
  f("keyframes", v.keyframes);
}

}  // namespace dubsar::app
