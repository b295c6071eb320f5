(* JSON as certificates have it: whole numbers of any length, and no key twice. *)

type t = Null | Bool of bool | Number of Z.t | Text of string | List of t list | Object of (string * t) list

exception Refused of string

let refuse message = raise (Refused message)

(* The value that begins at a place of a text, and the place after it. *)
let read text start =
  let place = ref start in
  let wrong () = refuse (Printf.sprintf "not JSON at character %d" !place) in
  let next () = if !place < String.length text then text.[!place] else wrong () in
  let rec blank () =
    if !place < String.length text && String.contains " \n\r\t" text.[!place] then (incr place; blank ()) in
  let expect c = if next () = c then incr place else wrong () in
  let word w value = String.iter expect w; value in
  let utf8 buffer code = Buffer.add_utf_8_uchar buffer (Uchar.of_int code) in
  let hex () =
    let digits = String.sub text !place 4 in
    place := !place + 4;
    match int_of_string_opt ("0x" ^ digits) with Some code -> code | None -> wrong () in
  let escaped buffer =
    let c = next () in
    incr place;
    match c with
    | '"' | '\\' | '/' -> Buffer.add_char buffer c
    | 'b' -> Buffer.add_char buffer '\b'
    | 'f' -> Buffer.add_char buffer '\012'
    | 'n' -> Buffer.add_char buffer '\n'
    | 'r' -> Buffer.add_char buffer '\r'
    | 't' -> Buffer.add_char buffer '\t'
    | 'u' ->
      let high = hex () in
      if high < 0xD800 || high > 0xDFFF then utf8 buffer high
      else begin
        expect '\\'; expect 'u';
        let low = hex () in
        if high > 0xDBFF || low < 0xDC00 || low > 0xDFFF then wrong ();
        utf8 buffer (0x10000 + ((high - 0xD800) lsl 10) + (low - 0xDC00))
      end
    | _ -> wrong () in
  let string () =
    let buffer = Buffer.create 16 in
    expect '"';
    while next () <> '"' do
      let c = next () in
      incr place;
      if c = '\\' then escaped buffer else if c < ' ' then wrong () else Buffer.add_char buffer c
    done;
    incr place;
    Buffer.contents buffer in
  let number () =
    let first = !place in
    if next () = '-' then incr place;
    while !place < String.length text && text.[!place] >= '0' && text.[!place] <= '9' do incr place done;
    if !place < String.length text && String.contains ".eE" text.[!place] then wrong ();
    match Z.of_string (String.sub text first (!place - first)) with n -> n | exception _ -> wrong () in
  let rec value () =
    blank ();
    let found = match next () with
      | '{' -> incr place; once (items '}' [] (fun () ->
          blank (); let key = string () in blank (); expect ':'; (key, value ())))
      | '[' -> incr place; List (items ']' [] value)
      | '"' -> Text (string ())
      | 'n' -> word "null" Null
      | 't' -> word "true" (Bool true)
      | 'f' -> word "false" (Bool false)
      | _ -> Number (number ()) in
    blank ();
    found
  and once pairs =
    let keys = List.sort compare (List.map fst pairs) in
    let rec twice = function a :: (b :: _ as others) -> a = b || twice others | _ -> false in
    if twice keys then refuse "a key stands twice in one object" else Object pairs
  and items : 'a. char -> 'a list -> (unit -> 'a) -> 'a list = fun close found one ->
    blank ();
    if found = [] && next () = close then (incr place; [])
    else begin
      let found = one () :: found in
      blank ();
      if next () = close then (incr place; List.rev found) else (expect ','; items close found one)
    end in
  let found = value () in
  (found, !place)

(* The text of which digests are computed: keys in order, no blanks, and ASCII only. *)
let canonical value =
  let out = Buffer.create 1_000_000 in
  let put = Buffer.add_string out in
  let escape code = put (Printf.sprintf "\\u%04x" code) in
  let rec character s i =
    if i < String.length s then begin
      let decoded = if s.[i] < '\128' then Uchar.of_char s.[i] else utf8_at s i in
      let code = Uchar.to_int decoded in
      (match s.[i] with
       | '"' -> put "\\\"" | '\\' -> put "\\\\" | '\n' -> put "\\n" | '\r' -> put "\\r" | '\t' -> put "\\t"
       | '\b' -> put "\\b" | '\012' -> put "\\f"
       | c when c >= ' ' && c < '\127' -> Buffer.add_char out c
       | '\127' -> put "\127"
       | _ when code < 0x10000 -> escape code
       | _ -> escape (0xD800 + ((code - 0x10000) lsr 10)); escape (0xDC00 + ((code - 0x10000) land 0x3FF)));
      character s (i + if code < 0x80 then 1 else if code < 0x800 then 2 else if code < 0x10000 then 3 else 4)
    end
  and utf8_at s i =
    let byte k = if i + k < String.length s then Char.code s.[i + k] land 0x3F else refuse "not UTF-8" in
    let b = Char.code s.[i] in
    let code =
      if b < 0xE0 then ((b land 0x1F) lsl 6) lor byte 1
      else if b < 0xF0 then ((b land 0x0F) lsl 12) lor (byte 1 lsl 6) lor byte 2
      else ((b land 0x07) lsl 18) lor (byte 1 lsl 12) lor (byte 2 lsl 6) lor byte 3 in
    if Uchar.is_valid code then Uchar.of_int code else refuse "not UTF-8" in
  let quoted s = put "\""; character s 0; put "\"" in
  let rec write = function
    | Null -> put "null"
    | Bool b -> put (string_of_bool b)
    | Number n -> put (Z.to_string n)
    | Text s -> quoted s
    | List l -> between "[" "]" write l
    | Object l -> between "{" "}" (fun (k, v) -> quoted k; put ":"; write v) (List.sort compare l)
  and between : 'a. string -> string -> ('a -> unit) -> 'a list -> unit = fun opening closing one l ->
    put opening;
    List.iteri (fun i x -> if i > 0 then put ","; one x) l;
    put closing in
  write value;
  Buffer.contents out

let pairs = function
  | Object pairs -> pairs
  | _ -> refuse "expected an object"
let rec ascending = function a :: (b :: _ as others) -> compare a b < 0 && ascending others | _ -> true
let exactly keys value =
  if List.sort compare (List.map fst (pairs value)) <> List.sort compare keys then
    refuse ("expected the keys " ^ String.concat ", " keys)
let get key value = match List.assoc_opt key (pairs value) with Some v -> v | None -> refuse ("expected the key " ^ key)
let get_opt key value = List.assoc_opt key (pairs value)
let list = function List l -> l | _ -> refuse "expected a list"
let text = function Text s -> s | _ -> refuse "expected text"
let number = function Number n -> n | _ -> refuse "expected a whole number"
let pair value = match list value with [a; b] -> (a, b) | _ -> refuse "expected a list of two"

(* A fraction such as 3/2, in lowest terms. *)
let fraction value =
  let written = text value in
  match Q.of_string written with
  | q when Q.to_string q = written && Z.sign q.Q.den > 0 -> q
  | _ -> refuse "expected a fraction in lowest terms"
  | exception _ -> refuse "expected a number such as 3/2"
