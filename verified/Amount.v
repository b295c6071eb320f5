(** * Amounts: what units cost, and what weights are

    An amount has one part for each objective, the most important first, and amounts are compared part by part,
    like words. A part is a whole number, which adds up, together with a factor, which multiplies: objectives
    that add up leave the factor at 1, and [success], a product of rates, leaves the number at 0. A unit of rate
    3/4 has the factor 4/3, so a smaller factor is a better one. Missing parts are 0 and 1: the empty list is the
    amount of nothing. *)

From Coq Require Import ZArith QArith List Lia.
Import ListNotations.
Open Scope Z_scope.

Record part := Part { number : Z; over : positive; under : positive }.
Definition amount := list part.

Definition nil_part := Part 0 1 1.
Definition plus_part a b := Part (number a + number b) (over a * over b) (under a * under b).
Definition minus_part a := Part (- number a) (under a) (over a).

Definition compare_part a b :=
  match number a ?= number b with
  | Eq => (over a * under b ?= over b * under a)%positive
  | decided => decided
  end.

(** Powers by squaring, so that 1 to a large power is found at once. *)
Fixpoint power_pos (p k : positive) : positive :=
  match k with
  | xH => p
  | xO k => let q := power_pos p k in q * q
  | xI k => let q := power_pos p k in p * (q * q)
  end%positive.
Definition power (p : positive) (k : N) := match k with N0 => 1%positive | Npos k => power_pos p k end.
Definition times_part k a := Part (Z.of_N k * number a) (power (over a) k) (power (under a) k).

Fixpoint plus (a b : amount) : amount :=
  match a, b with
  | [], _ => b
  | _, [] => a
  | p :: a', q :: b' => plus_part p q :: plus a' b'
  end.
Definition minus (a : amount) : amount := map minus_part a.
Definition times (k : N) (a : amount) : amount := map (times_part k) a.

Definition first (a : amount) := hd nil_part a.

(** Comparison of the first [n] parts. *)
Fixpoint compare (n : nat) (a b : amount) : comparison :=
  match n with
  | O => Eq
  | S n => match compare_part (first a) (first b) with
           | Eq => compare n (tl a) (tl b)
           | decided => decided
           end
  end.
Definition le n a b := compare n a b <> Gt.
Definition leb n a b := match compare n a b with Gt => false | _ => true end.

(** The sum of an amount over a list. *)
Fixpoint total {A} (f : A -> amount) (l : list A) : amount :=
  match l with [] => [] | x :: l => plus (f x) (total f l) end.

(** [leb] decides [le]. *)
Lemma leb_le n a b : leb n a b = true <-> le n a b.
Proof. unfold leb, le. destruct (compare n a b); intuition congruence. Qed.

(** ** Parts

    Parts are ordered as pairs of a whole number and a fraction; the laws are those of Coq's [Z] and [Q]. *)

Definition fraction a : Q := Zpos (over a) # under a.

(** The comparison of factors is that of fractions in [Q]. *)
Lemma compare_part_fraction a b :
  compare_part a b = match number a ?= number b with Eq => (fraction a ?= fraction b)%Q | c => c end.
Proof. reflexivity. Qed.

(** Each part equals itself. *)
Lemma part_refl a : compare_part a a = Eq.
Proof. unfold compare_part. rewrite Z.compare_refl. apply Pos.compare_refl. Qed.

(** Both comparisons, of numbers and of factors, are reversed. *)
Lemma part_sym a b : compare_part b a = CompOpp (compare_part a b).
Proof.
  unfold compare_part. rewrite (Z.compare_antisym (number a)), (Pos.compare_antisym (over a * under b)).
  now destruct (number a ?= number b).
Qed.

(** Equal parts have equal numbers and equal fractions, and [Q] compares equal fractions alike. *)
Lemma part_eq a b c : compare_part a b = Eq -> compare_part a c = compare_part b c.
Proof.
  rewrite !compare_part_fraction. destruct (Z.compare_spec (number a) (number b)) as [E| |]; try discriminate.
  intros H. apply Qeq_alt in H. rewrite E. destruct (number b ?= number c); trivial. now rewrite H.
Qed.

(** The first difference decides: by the order of [Z] for numbers, and else by that of [Q]. *)
Lemma part_trans a b c : compare_part a b = Lt -> compare_part b c = Lt -> compare_part a c = Lt.
Proof.
  rewrite !compare_part_fraction.
  destruct (Z.compare_spec (number a) (number b)); try discriminate;
    destruct (Z.compare_spec (number b) (number c)); try discriminate;
    destruct (Z.compare_spec (number a) (number c)); try lia; trivial.
  rewrite <- !Qlt_alt. apply Qlt_trans.
Qed.

(** Adding the same on both sides changes no comparison: the products gain a common factor. *)
Lemma part_plus a b c : compare_part (plus_part a c) (plus_part b c) = compare_part a b.
Proof.
  unfold compare_part; cbn. rewrite (Z.add_comm (number a)), (Z.add_comm (number b)), Z.add_compare_mono_l.
  destruct (number a ?= number b); trivial.
  replace (over a * over c * (under b * under c))%positive with ((over c * under c) * (over a * under b))%positive by lia.
  replace (over b * over c * (under a * under c))%positive with ((over c * under c) * (over b * under a))%positive by lia.
  apply Pos.mul_compare_mono_l.
Qed.

(** The numbers add up to 0, and the factors to p*q / q*p. *)
Lemma part_minus a : compare_part (plus_part a (minus_part a)) nil_part = Eq.
Proof.
  unfold compare_part; cbn. rewrite Z.add_opp_diag_r. cbn. rewrite Pos.mul_1_r, (Pos.mul_comm (under a)).
  apply Pos.compare_refl.
Qed.

(** Part by part, from [Z] and [positive]. *)
Lemma plus_part_comm a b : plus_part a b = plus_part b a.
Proof. unfold plus_part; f_equal; lia. Qed.
(** Likewise. *)
Lemma plus_part_assoc a b c : plus_part a (plus_part b c) = plus_part (plus_part a b) c.
Proof. unfold plus_part; f_equal; cbn; lia. Qed.
(** The part of nothing adds 0 and multiplies by 1. *)
Lemma plus_part_nil a : plus_part a nil_part = a.
Proof. destruct a; unfold plus_part; cbn; f_equal; lia. Qed.

(** ** Amounts *)

(** Amounts are added part by part, so the laws of parts hold for them, by induction along the list. *)
Lemma plus_comm a : forall b, plus a b = plus b a.
Proof. induction a as [|p a IH]; intros [|q b]; cbn; trivial. now rewrite plus_part_comm, IH. Qed.
(** Nothing adds nothing. *)
Lemma plus_nil a : plus a [] = a.
Proof. now destruct a. Qed.
(** As [plus_comm]. *)
Lemma plus_assoc a : forall b c, plus a (plus b c) = plus (plus a b) c.
Proof. induction a as [|p a IH]; intros [|q b] [|r c]; cbn; trivial. now rewrite plus_part_assoc, IH. Qed.
(** From the two laws before. *)
Lemma plus_swap a b c : plus a (plus b c) = plus b (plus a c).
Proof. now rewrite plus_assoc, (plus_comm a), <- plus_assoc. Qed.

(** The first part of a sum is the sum of first parts, also where one is missing. *)
Lemma first_plus a b : first (plus a b) = plus_part (first a) (first b).
Proof. destruct a, b; cbn; rewrite ?plus_part_nil; trivial. now rewrite plus_part_comm, plus_part_nil. Qed.
(** Likewise of the parts after the first. *)
Lemma tl_plus a b : tl (plus a b) = plus (tl a) (tl b).
Proof. destruct a, b; cbn; trivial. now rewrite plus_nil. Qed.

Section Order.
Variable n : nat.
Implicit Types a b c : amount.

(** By induction on the number of parts, here and in the next lemmas; the first part decides, or the others do. *)
Lemma refl a : compare n a a = Eq.
Proof. revert a; induction n as [|k IH]; intros a; cbn; trivial. now rewrite part_refl. Qed.

(** Each part is compared the other way round. *)
Lemma sym a b : compare n b a = CompOpp (compare n a b).
Proof.
  revert a b; induction n as [|k IH]; intros a b; cbn; trivial.
  rewrite (part_sym (first a)). destruct (compare_part (first a) (first b)); cbn; trivial.
Qed.

(** Equal amounts have equal parts, which compare alike. *)
Lemma eq_l a b c : compare n a b = Eq -> compare n a c = compare n b c.
Proof.
  revert a b c; induction n as [|k IH]; intros a b c; cbn; trivial.
  destruct (compare_part (first a) (first b)) eqn:E; try discriminate.
  intros H. rewrite (part_eq _ _ _ E). destruct (compare_part (first b) (first c)); auto.
Qed.

(** Where the first parts differ somewhere, they decide; otherwise the parts after them do. *)
Lemma lt_trans a b c : compare n a b = Lt -> compare n b c = Lt -> compare n a c = Lt.
Proof.
  revert a b c; induction n as [|k IH]; intros a b c; cbn; try discriminate.
  destruct (compare_part (first a) (first b)) eqn:E; try discriminate.
  - rewrite (part_eq _ _ _ E). destruct (compare_part (first b) (first c)); eauto.
  - intros _. destruct (compare_part (first b) (first c)) eqn:F; try discriminate.
    + intros _. rewrite part_sym, <- (part_eq (first b) (first c) (first a) F), <- part_sym, E. trivial.
    + intros _. now rewrite (part_trans _ _ _ E F).
Qed.

(** From [refl]. *)
Lemma le_refl a : le n a a.
Proof. unfold le. now rewrite refl. Qed.

(** Either comparison is equal, and then [eq_l] applies, or both are below, and then [lt_trans] does. *)
Lemma le_trans a b c : le n a b -> le n b c -> le n a c.
Proof.
  unfold le. destruct (compare n a b) eqn:E; [now rewrite (eq_l _ _ _ E)| |congruence].
  intros _. destruct (compare n b c) eqn:F; [|now rewrite (lt_trans _ _ _ E F)|congruence].
  rewrite sym, <- (eq_l b c a F), <- sym, E. congruence.
Qed.

(** The same part is added to each part on both sides, which changes no comparison ([part_plus]). *)
Lemma plus_both a b c : compare n (plus a c) (plus b c) = compare n a b.
Proof.
  revert a b c; induction n as [|k IH]; intros a b c; cbn; trivial.
  now rewrite !first_plus, !tl_plus, part_plus, IH.
Qed.

(** From [plus_both]. *)
Lemma le_plus_r a b c : le n (plus a c) (plus b c) <-> le n a b.
Proof. unfold le. now rewrite plus_both. Qed.
(** From [plus_both], as the order of addition does not matter. *)
Lemma le_plus_l a b c : le n (plus c a) (plus c b) <-> le n a b.
Proof. rewrite !(plus_comm c). apply le_plus_r. Qed.

(** Two comparisons are added one after the other. *)
Lemma le_plus a b a' b' : le n a b -> le n a' b' -> le n (plus a a') (plus b b').
Proof. intros H K. apply le_trans with (plus b a'); [now apply le_plus_r|now apply le_plus_l]. Qed.

(** What is at least nothing can be left out of the right side. *)
Lemma le_more a b c : le n a b -> le n [] c -> le n a (plus b c).
Proof. intros H K. rewrite <- (plus_nil a). now apply le_plus. Qed.

(** Part by part, from [part_minus]. *)
Lemma minus_nil a : compare n (plus a (minus a)) [] = Eq.
Proof.
  revert a; induction n as [|k IH]; intros a; cbn; trivial.
  rewrite first_plus, tl_plus. replace (first (minus a)) with (minus_part (first a)) by now destruct a.
  replace (tl (minus a)) with (minus (tl a)) by now destruct a. rewrite part_minus.
  apply IH.
Qed.

(** A subtraction goes to the other side. *)
Lemma le_minus a b c : le n (plus a (minus b)) c <-> le n a (plus c b).
Proof.
  rewrite <- (le_plus_r (plus a (minus b)) c b), <- plus_assoc, (plus_comm (minus b)).
  assert (E : compare n (plus a (plus b (minus b))) a = Eq).
  { rewrite <- (plus_nil a) at 2. rewrite (plus_comm a), (plus_comm a), plus_both. apply minus_nil. }
  unfold le. now rewrite (eq_l _ _ _ E).
Qed.

(** ** Multiples *)

(** By the binary digits of the exponent: one more multiplies by the base once more. *)
Lemma power_succ p k : power p (N.succ k) = (p * power p k)%positive.
Proof.
  destruct k as [|k]; cbn; [now rewrite Pos.mul_1_r|]. induction k as [k IH|k IH|]; cbn; trivial.
  rewrite IH. lia.
Qed.

(** One more factor of 1 changes nothing. *)
Lemma power_1 k : power 1 k = 1%positive.
Proof. induction k as [|k IH] using N.peano_ind; [reflexivity|]. now rewrite power_succ, IH. Qed.

(** Factor by factor. *)
Lemma power_mul p q k : power (p * q) k = (power p k * power q k)%positive.
Proof. induction k as [|k IH] using N.peano_ind; [reflexivity|]. rewrite !power_succ, IH. lia. Qed.

(** A multiple is a repeated sum, part by part. *)
Lemma times_succ k a : times (N.succ k) a = plus a (times k a).
Proof.
  induction a as [|p a IH]; cbn; trivial. f_equal; trivial.
  unfold times_part, plus_part; cbn. f_equal; [lia| |]; apply power_succ.
Qed.

(** No number and the factor 1, in each part. *)
Lemma times_0 a : compare n (times 0 a) [] = Eq.
Proof.
  revert a; induction n as [|k IH]; intros a; cbn; trivial.
  replace (compare_part (first (times 0 a)) nil_part) with Eq by now destruct a.
  replace (tl (times 0 a)) with (times 0 (tl a)) by now destruct a. apply IH.
Qed.

(** Part by part. *)
Lemma times_1 a : times 1 a = a.
Proof.
  induction a as [|[z p q] a IH]; cbn [times map]; trivial. f_equal; trivial.
  unfold times_part, power; cbn [number over under]. cbn [power_pos]. f_equal. lia.
Qed.

(** Part by part: multiplication distributes, and powers of products are products of powers. *)
Lemma times_plus k a : forall b, times k (plus a b) = plus (times k a) (times k b).
Proof.
  induction a as [|p a IH]; intros [|q b]; cbn; trivial. f_equal; [|apply IH].
  unfold times_part, plus_part; cbn [number over under]. rewrite !power_mul. f_equal. lia.
Qed.

(** By adding [a] again and again, as [plus_both] allows, a multiple keeps its side of nothing. *)
Lemma times_nonneg k a : le n [] a -> le n [] (times k a).
Proof.
  intros H. induction k as [|k IH] using N.peano_ind.
  - unfold le. rewrite sym, times_0. discriminate.
  - rewrite times_succ. now apply le_more.
Qed.

(** Adding a comparison to itself again and again. *)
Lemma times_le k a b : le n a b -> le n (times k a) (times k b).
Proof.
  intros H. induction k as [|k IH] using N.peano_ind.
  - unfold le. rewrite (eq_l _ _ _ (times_0 a)), sym, times_0. discriminate.
  - rewrite !times_succ. now apply le_plus.
Qed.

(** If the multiples were not below, adding up what is known would give b at most a. *)
Lemma times_lt k a b : (0 < k)%N -> compare n a b = Lt -> compare n (times k a) (times k b) = Lt.
Proof.
  intros Hk H. destruct (N.lt_exists_pred _ _ Hk) as (j & -> & _). clear Hk.
  assert (L : le n (times j a) (times j b)) by (apply times_le; unfold le; now rewrite H).
  rewrite !times_succ. destruct (compare n (plus a (times j a)) (plus b (times j b))) eqn:E; trivial; exfalso;
    assert (K : le n (plus b (times j b)) (plus a (times j a))) by (unfold le; rewrite sym, E; discriminate);
    assert (M : le n (plus b (times j b)) (plus a (times j b))) by
      (eapply le_trans; [apply K|]; now apply le_plus_l);
    apply le_plus_r in M; apply M; now rewrite sym, H.
Qed.

(** So multiples can be compared in place of what they are multiples of. *)
Lemma times_cancel k a b : (0 < k)%N -> le n (times k a) (times k b) -> le n a b.
Proof.
  intros Hk H G. apply H. rewrite sym, times_lt; trivial. now rewrite sym, G.
Qed.

(** Each further copy is at least nothing. *)
Lemma times_more j k a : le n [] a -> (j <= k)%N -> le n (times j a) (times k a).
Proof.
  intros H L. replace k with (j + (k - j))%N by lia. induction (k - j)%N as [|i IH] using N.peano_ind.
  - rewrite N.add_0_r. apply le_refl.
  - replace (j + N.succ i)%N with (N.succ (j + i)) by lia. rewrite times_succ, plus_comm. now apply le_more.
Qed.

(** ** Sums *)

(** The sums here are over lists; each lemma is by induction along the list. *)
Lemma total_app {A} (f : A -> amount) l m : total f (l ++ m) = plus (total f l) (total f m).
Proof. induction l as [|x l IH]; cbn; trivial. now rewrite IH, plus_assoc. Qed.

(** Sums are regrouped. *)
Lemma total_plus {A} (f g : A -> amount) l : total (fun x => plus (f x) (g x)) l = plus (total f l) (total g l).
Proof.
  induction l as [|x l IH]; cbn; trivial. rewrite IH, <- !plus_assoc. f_equal. apply plus_swap.
Qed.

(** Each comparison is added. *)
Lemma total_le {A} (f g : A -> amount) l : (forall x, In x l -> le n (f x) (g x)) -> le n (total f l) (total g l).
Proof. induction l as [|x l IH]; intros H; cbn; [apply le_refl|apply le_plus; auto with datatypes]. Qed.

(** Nothing many times is nothing. *)
Lemma total_nil {A} (l : list A) : total (fun _ => []) l = [].
Proof. induction l; cbn; trivial. Qed.

(** By comparison with the sum of nothings. *)
Lemma total_nonneg {A} (f : A -> amount) l : (forall x, In x l -> le n [] (f x)) -> le n [] (total f l).
Proof. intros H. rewrite <- (total_nil l). now apply total_le. Qed.

(** Each summand is multiplied. *)
Lemma total_times {A} k (f : A -> amount) l : total (fun x => times k (f x)) l = times k (total f l).
Proof. induction l as [|x l IH]; cbn [total]; trivial. now rewrite IH, times_plus. Qed.
End Order.
