#include "codec/meta_update.h"

#include "codec/gate_meta.h"
#include "codec/paper_meta.h"
#include "codec/plain_meta.h"

namespace atlaswire::codec {

const char* name(MetaCodecKind kind) {
  switch (kind) {
    case MetaCodecKind::kPlain:
      return "plain";
    case MetaCodecKind::kGate:
      return "gate";
    case MetaCodecKind::kMirror:
      return "mirror";
    case MetaCodecKind::kPaper:
      return "paper";
  }
  return "unknown";
}

std::optional<MetaCodecKind> find_meta_codec(std::string_view name_of_one) {
  for (const MetaCodecKind kind : kMetaCodecs) {
    if (name(kind) == name_of_one) return kind;
  }
  return std::nullopt;
}

std::unique_ptr<MetaEncoder> make_meta_encoder(MetaCodecKind kind, const MetaLimits& limits) {
  switch (kind) {
    case MetaCodecKind::kPlain:
      return std::make_unique<PlainMetaEncoder>();
    case MetaCodecKind::kGate:
      return std::make_unique<GateMetaEncoder>(limits);
    case MetaCodecKind::kMirror:
      return std::make_unique<GateMetaEncoder>(limits, BlockPositions::kDerived);
    case MetaCodecKind::kPaper:
      return std::make_unique<PaperMetaEncoder>(limits);
  }
  return nullptr;
}

std::unique_ptr<MetaDecoder> make_meta_decoder(MetaCodecKind kind, const MetaLimits& limits) {
  switch (kind) {
    case MetaCodecKind::kPlain:
      return std::make_unique<PlainMetaDecoder>(limits);
    case MetaCodecKind::kGate:
      return std::make_unique<GateMetaDecoder>(limits);
    case MetaCodecKind::kMirror:
      return std::make_unique<GateMetaDecoder>(limits, BlockPositions::kDerived);
    case MetaCodecKind::kPaper:
      return std::make_unique<PaperMetaDecoder>(limits);
  }
  return nullptr;
}

const char* error_text(MetaError e) {
  switch (e) {
    case MetaError::kTruncated:
      return "the meta update ends early";
    case MetaError::kTrailingBytes:
      return "octets follow the meta update's end";
    case MetaError::kBadVersion:
      return "not a meta update of a form this program knows";
    case MetaError::kTooLarge:
      return "the meta update is larger than allowed";
    case MetaError::kIdOutOfRange:
      return "a patch or vertex id beyond the scene's";
    case MetaError::kBadPosition:
      return "a vertex position outside the grid";
    case MetaError::kBadBlock:
      return "a block that is not landscape or not inside the atlas";
    case MetaError::kBadPatch:
      return "a patch with an impossible triangle count or drawing class";
    case MetaError::kBadOrder:
      return "a vertex that comes twice, or a moved patch that the same update adds or removes";
    case MetaError::kOutOfStep:
      return "the meta update does not continue what this end knows";
  }
  return "unknown meta error";
}

}  // namespace atlaswire::codec
