// SPDX-License-Identifier: GPL-3.0-or-later

// Sends the newest of what is wanted: at once if nothing is under way, else when the server has answered and the pause
// [ms] is over. So a slow body is asked no more often than it steps, and the last wish is always sent.
export class Latest {
  constructor(send, pause) {
    Object.assign(this, { send, pause });
    this.wish = null;
    this.isUnanswered = false;
    this.rests = false;
  }

  get isBusy() {
    return this.isUnanswered || this.wish !== null;
  }

  want(wish) {
    this.wish = wish;
    this.go();
  }

  answered() {
    this.isUnanswered = false;
    this.go();
  }

  go() {
    if (this.wish === null || this.rests || this.isUnanswered)
      return;
    const { wish } = this;
    this.wish = null;
    this.isUnanswered = true;
    this.rests = true;
    setTimeout(() => {
      this.rests = false;
      this.go();
    }, this.pause);
    this.send(wish);
  }
}
