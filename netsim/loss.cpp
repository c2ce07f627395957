#include "netsim/loss.h"

#include <algorithm>

namespace atlaswire::netsim {

bool LossProcess::lose(const LossModel& model, std::uint64_t packet) {
  const double first = random_.uniform();
  const double second = random_.uniform();
  switch (model.kind) {
    case LossModel::Kind::kNone:
      return false;
    case LossModel::Kind::kBernoulli:
      return first < model.probability;
    case LossModel::Kind::kGilbertElliott:
      return gilbert_elliott(model, first, second);
    case LossModel::Kind::kFourState:
      return four_state(model, first);
    case LossModel::Kind::kPeriodic:
      return model.period > 0 && packet % model.period >= model.period - std::min(model.burst, model.period);
    case LossModel::Kind::kList:
      return std::binary_search(model.list.begin(), model.list.end(), packet);
  }
  return false;
}

bool LossProcess::gilbert_elliott(const LossModel& model, double move, double loss) {
  bad_ = bad_ ? !(move < model.r) : move < model.p;
  return loss < (bad_ ? model.loss_bad : model.loss_good);
}

bool LossProcess::four_state(const LossModel& model, double move) {
  switch (state_) {
    case 1:
      state_ = move < model.p13 ? 3 : move < model.p13 + model.p14 ? 4 : 1;
      break;
    case 2:
      state_ = move < model.p23 ? 3 : 2;
      break;
    case 3:
      state_ = move < model.p31 ? 1 : move < model.p31 + model.p32 ? 2 : 3;
      break;
    default:
      state_ = 1;
      break;
  }
  return state_ >= 3;
}

double gilbert_elliott_loss(const LossModel& model) {
  const double bad = model.p + model.r > 0 ? model.p / (model.p + model.r) : 0;
  return bad * model.loss_bad + (1 - bad) * model.loss_good;
}

}  // namespace atlaswire::netsim
